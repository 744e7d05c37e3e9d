#include "cli/interrupt.h"

#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "gnomon.h"

#define GRACE_NANOSECONDS 800000000L

static volatile sig_atomic_t signals, held, due;
static bool with_json, with_terminal;
static timer_t watchdog;
static bool has_watchdog;

// The end, from a handler: only what is safe there.
static void end_now(void) {
    static const char object[] = "{\"error\": {\"status\": 130, \"message\": \"interrupted\"}}\n", wipe[] = "\r\033[K";
    if (held) {
        due = 1;
        return;
    }
    if (with_terminal && write(STDERR_FILENO, wipe, sizeof wipe - 1) < 0) {}
    if (with_json && write(STDOUT_FILENO, object, sizeof object - 1) < 0) {}
    _exit(GN_CANCELLED);
}

static void on_signal(int number) {
    (void)number;
    signals = signals < 2 ? signals + 1 : 2;
    if (signals > 1) end_now();
    const struct itimerspec grace = {.it_value.tv_nsec = GRACE_NANOSECONDS};
    if (has_watchdog) timer_settime(watchdog, 0, &grace, NULL);
}

static void on_alarm(int number) {
    (void)number;
    end_now();
}

static void catch_signal(int number, void (*handler)(int)) {
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigfillset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void interrupt_install(bool json, bool terminal) {
    with_json = json, with_terminal = terminal;
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGALRM};
    has_watchdog = timer_create(CLOCK_MONOTONIC, &event, &watchdog) == 0;
    struct sigaction old;
    catch_signal(SIGALRM, on_alarm);
    catch_signal(SIGINT, on_signal);
    catch_signal(SIGTERM, on_signal);
    if (sigaction(SIGHUP, NULL, &old) == 0 && old.sa_handler != SIG_IGN) catch_signal(SIGHUP, on_signal);
    catch_signal(SIGPIPE, SIG_IGN);
    catch_signal(SIGXFSZ, SIG_IGN);
}

bool interrupt_requested(void) { return signals > 0; }

void interrupt_hold(void) { held = 1; }

void interrupt_release(void) {
    held = 0;
    if (due) end_now();
}
