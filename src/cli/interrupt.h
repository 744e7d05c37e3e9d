// Ctrl-C and its relatives: noted by a handler, noticed by the progress callback, and enforced if nobody notices.
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

// Catches SIGINT, SIGTERM and SIGHUP (unless nohup has it ignored), and ignores SIGPIPE and SIGXFSZ, so that a closed pipe and a full quota
// are write errors. The first signal sets a flag. If the program has not ended 0.8 s later, or at the second signal, it ends at once with
// 130; with `json` the one object is printed even then. `terminal`: a progress bar may have to be wiped out.
void interrupt_install(bool json, bool terminal);

// Whether a signal came.
bool interrupt_requested(void);

// Between hold and release the program is not ended at once: an output is being written, and is finished first.
void interrupt_hold(void);
void interrupt_release(void);

#endif
