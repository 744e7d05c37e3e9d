// In fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "twin_fog.glsl"
