// The functions of environment.glsl in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_sky.glsl"
