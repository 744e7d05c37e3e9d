// Materials, cameras and lights of an Assimp scene, as ours.
#ifndef SCENE_ASSIMP_LOOK_H
#define SCENE_ASSIMP_LOOK_H

#include <assimp/cimport.h>
#include <assimp/scene.h>

#include "scene/mesh.h"

// The material's name, "" for none and for the one that Assimp makes up.
void look_material_name(const struct aiMaterial *material, char *name, size_t capacity);

// Fills colors and shininess. Metal and roughness become Phong terms (see the .c file); other materials have them already.
void look_material(struct scene_material *out, const struct aiMaterial *material);

// Whether the camera is one of ours, with *node the transform to the world.
bool look_camera(struct scene_camera *out, const struct aiCamera *camera, const struct transform *node);

// Whether the light is one of ours: a point. Intensities keep the file's unit, which is candela in glTF.
bool look_light(struct scene_light *out, const struct aiLight *light, const struct transform *node);

#endif
