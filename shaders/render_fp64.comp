// Renders a picture in fp64: every ray, hit and shade in double.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FP64
#include "render.glsl"
