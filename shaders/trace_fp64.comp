// Shoots a batch of rays in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "trace.glsl"
