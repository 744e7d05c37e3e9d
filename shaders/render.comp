// Renders a picture in fp32.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render.glsl"
