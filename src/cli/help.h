// What the program says about itself: the table of commands with their texts, --help and --version.
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "cli/command.h"

// The command of this name, or NULL.
const struct command *command_find(const char *name);

// A command whose name is nearly this, or NULL.
const struct command *command_near(const char *name);

// Whether a later version will have this command.
bool command_planned(const char *name);

// To standard output: all commands; one command; the version.
void help_overview(void);
void help_command(const struct command *command);
void help_version(void);

#endif
