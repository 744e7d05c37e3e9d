// Shoots a batch of rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "trace.glsl"
