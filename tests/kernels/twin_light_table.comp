// Lights by their numbers, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_light_table.glsl"
