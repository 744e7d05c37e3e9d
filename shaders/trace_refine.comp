// Shoots a batch of rays in fp32, and brings the hits of the exact tier to 1 ulp in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define REFINE
#include "trace.glsl"
