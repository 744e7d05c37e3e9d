#include "cli/wrap.h"

#include <stdio.h>
#include <string.h>

// Characters of UTF-8, one column each.
static int columns(const char *text, size_t bytes) {
    int count = 0;
    for (size_t i = 0; i < bytes; i++) count += ((unsigned char)text[i] & 0xc0) != 0x80;
    return count;
}

void print_wrapped(const char *text, int column, int indent) {
    if (column < indent) printf("%*s", indent - column, ""), column = indent;
    else if (indent > 0) printf("\n%*s", indent, ""), column = indent;
    for (int start = column; *text; text += *text != 0) {
        size_t length = strcspn(text, " \n");
        int width = columns(text, length);
        if (column > start && column + 1 + width > HELP_WIDTH) printf("\n%*s", indent, ""), start = column = indent;
        if (column > start) putchar(' '), column++;
        printf("%.*s", (int)length, text);
        column += width;
        text += length;
        if (*text == '\n') printf("\n%*s", indent, ""), start = column = indent;
    }
    putchar('\n');
}
