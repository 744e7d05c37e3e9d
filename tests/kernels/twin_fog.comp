// The functions of fog.glsl in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_fog.glsl"
