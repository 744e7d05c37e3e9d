// Shoots a batch of rays on a device with doubles.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "trace.glsl"
