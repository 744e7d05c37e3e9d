// Rays that leave a surface, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stress_leave.glsl"
