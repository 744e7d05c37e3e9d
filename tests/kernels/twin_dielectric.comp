// In fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twin_dielectric.glsl"
