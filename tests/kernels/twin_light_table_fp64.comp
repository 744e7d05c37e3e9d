// Lights by their numbers, in fp64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "twin_light_table.glsl"
