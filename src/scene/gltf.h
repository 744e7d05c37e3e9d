// glTF 2.0 files (.gltf, .glb), checked and repacked.
//
// Assimp trusts what it reads: a broken file crashes it, or loses faces without a word. So we check here all that we use of a file, report
// what is wrong with its place in the file's JSON, and write a GLB that has nothing else in it: one buffer, and the geometry, nodes,
// materials, cameras and point lights of one scene. Assimp reads that. Source: Khronos Group, "glTF 2.0 Specification", 2.0.1, 2021.
#ifndef SCENE_GLTF_H
#define SCENE_GLTF_H

#include "base/file.h"

// The file at `path` as a sound GLB in memory. Node names become "node <number>", unnamed materials "material <number>", cameras have
// aspect 1.
bool gltf_repack(struct file_bytes *out, struct context *ctx, const char *path);

#endif
