// What a device makes of fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "arithmetic.glsl"
