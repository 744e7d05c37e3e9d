// Boxes alone, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "stress_box.glsl"
