// Shoots a batch of rays in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "trace.glsl"
