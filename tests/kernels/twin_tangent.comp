// The functions of normal_map.glsl, and what texture.glsl does with coordinates, in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_tangent.glsl"
