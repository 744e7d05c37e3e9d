// How far a build is, told to the caller about 20 times a second from within parallel loops.
#ifndef BVH_WATCH_H
#define BVH_WATCH_H

#include <stdatomic.h>

#include "base/context.h"

struct bvh_watch {
    struct context *ctx;
    double start, reported; // seconds; touched by the calling thread only
    uint64_t work;          // of the whole build, as bvh_work counts it
    _Atomic uint64_t done;
};

// Begins to watch a build over `count` primitives. False when cancelled, as below.
bool bvh_watch_begin(struct bvh_watch *watch, struct context *ctx, uint32_t count);

// To be called after every piece of work of some milliseconds by the thread with this number in its loop; number 0, the calling thread,
// reports when it is time to. False, with GN_CANCELLED set, when the caller wants to stop.
bool bvh_watch_go_on(struct bvh_watch *watch, unsigned thread);

// Tells that all is done. False when cancelled.
bool bvh_watch_end(struct bvh_watch *watch);

// About what it takes to split a set of primitives to the end: its size times the levels below it.
uint64_t bvh_work(uint32_t count);

#endif
