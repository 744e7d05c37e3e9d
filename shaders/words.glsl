// The scene's arrays, as shared.h lays them out, behind one function each: what else they could be read from is decided here.
// Uniform texel buffers are the fastest path on software devices, and reach 2 GiB.
#ifndef WORDS_GLSL
#define WORDS_GLSL
#include "shared.h"

layout(set = 0, binding = BINDING_NODES) uniform usamplerBuffer node_words;
layout(set = 0, binding = BINDING_TRIANGLES) uniform usamplerBuffer triangle_words;
layout(set = 0, binding = BINDING_SPHERES) uniform usamplerBuffer sphere_words;
layout(set = 0, binding = BINDING_INSTANCES) uniform usamplerBuffer instance_words;

uvec4 node_word(uint word) { return texelFetch(node_words, int(word)); }
uvec4 triangle_word(uint word) { return texelFetch(triangle_words, int(word)); }
uvec4 sphere_word(uint word) { return texelFetch(sphere_words, int(word)); }
uvec4 instance_word(uint word) { return texelFetch(instance_words, int(word)); }

#endif
