// Text broken into lines for the screen.
#ifndef CLI_WRAP_H
#define CLI_WRAP_H

// Columns that help texts keep to.
#define HELP_WIDTH 80

// Prints `text` to standard output, broken at blanks, each line but the first indented to `indent`; the cursor is at column `column`
// before. A new line in the text stays one. Ends with a new line.
void print_wrapped(const char *text, int column, int indent);

#endif
