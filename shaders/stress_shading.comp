// One function of shading at a time, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stress_shading.glsl"
