// HTML on its way to a file: text, numbers, pictures. What goes wrong with the file is found by output_commit.
//
// What is written is XML, too: every element is closed, every attribute quoted.
#ifndef MEASURE_COST_HTML_H
#define MEASURE_COST_HTML_H

#include <stdio.h>

#include "base/file.h"
#include "base/image.h"

// Text with the characters escaped that mean something; bytes that are not UTF-8 become question marks.
void html_text(FILE *to, const char *text);

// A picture as an <img> with its data in it.
bool html_image(FILE *to, struct context *ctx, const struct image *image, enum transfer transfer, const char *alternative);

// A number of three digits for people: "0", "0.0612", "61.6", "1 240", or "4.47·10⁻⁷" where it is very small or large.
void html_number(FILE *to, double value);

// A whole number, its digits in groups of three.
void html_count(FILE *to, uint64_t value);

#endif
