// The exact tier's second stage for a batch of rays: those that fp32 left undecided, in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#define REFINE
#define LISTED
#include "trace.glsl"
