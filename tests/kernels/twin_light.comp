// The lights that have a size, and the spot's cone, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_light.glsl"
