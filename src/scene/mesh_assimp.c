// Meshes by way of Assimp, of whatever it reads. All meshes of all nodes become one, depth first; polygons are
// fanned here, points and lines left out.
#include "scene/import.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/assimp_look.h"
#include "scene/material.h"
#include "scene/words.h"

#define MOST_DEPTH 1000 // of the tree of nodes
#define MOST_LIGHTS 1024
#define MOST_CAMERAS 16
#define NO_MATERIAL UINT32_MAX

// A scene being taken over. The tree is walked twice: to count, and to fill.
struct import {
    struct context *ctx;
    const char *path;
    const struct aiScene *scene;
    bool filling;                 // the second walk
    uint64_t vertices, triangles; // counted, or filled so far
    bool has_normals;
    struct scene_mesh *mesh;
    struct material_table materials;
    uint32_t *material_numbers;                      // of Assimp's materials ours, or NO_MATERIAL
    struct transform cameras[MOST_CAMERAS], *lights; // of the nodes they hang on
    unsigned camera_count, light_count;
};

static struct transform node_transform(const struct aiNode *node) {
    const struct aiMatrix4x4 *m = &node->mTransformation;
    return (struct transform){{{m->a1, m->a2, m->a3, m->a4}, {m->b1, m->b2, m->b3, m->b4}, {m->c1, m->c2, m->c3, m->c4}, {0, 0, 0, 1}}};
}

// -------------------------------------------------------------------------------------------------------------- one mesh

static bool count_mesh(struct import *import, const struct aiMesh *mesh) {
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        if (mesh->mFaces[i].mNumIndices >= 3) import->triangles += mesh->mFaces[i].mNumIndices - 2;
    import->vertices += mesh->mNumVertices;
    import->has_normals |= mesh->mNormals != NULL;
    return mesh_count_allowed(import->ctx, import->path, import->triangles);
}

// Copies the vertices as they are. A normal that is no number counts as none.
static bool fill_vertices(struct import *import, const struct aiMesh *mesh) {
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D p = mesh->mVertices[i];
        float *position = import->mesh->positions + 3 * (import->vertices + i);
        position[0] = p.x, position[1] = p.y, position[2] = p.z;
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
            return fail(import->ctx, GN_SCENE, "%s: vertex %u of mesh '%s' is (%g, %g, %g), expected finite numbers", import->path, i,
                        excerpt_word(mesh->mName.data).text, (double)p.x, (double)p.y, (double)p.z);
        if (!mesh->mNormals) continue;
        const struct aiVector3D n = mesh->mNormals[i];
        float *normal = import->mesh->normals + 3 * (import->vertices + i);
        if (isfinite(n.x) && isfinite(n.y) && isfinite(n.z)) normal[0] = n.x, normal[1] = n.y, normal[2] = n.z;
    }
    return true;
}

// The number of our material for one of Assimp's, which is added when it is new.
static bool find_material(uint32_t *number, struct import *import, unsigned index) {
    uint32_t *known = &import->material_numbers[index];
    if (*known == NO_MATERIAL) {
        char name[256];
        look_material_name(import->scene->mMaterials[index], name, sizeof name);
        *known = (uint32_t)import->materials.items.count;
        struct scene_material *material = material_add(&import->materials, import->ctx, *name ? name : DEFAULT_MATERIAL);
        if (!material) return false;
        if (*name) look_material(material, import->scene->mMaterials[index]);
    }
    *number = *known;
    return true;
}

static bool fill_triangles(struct import *import, const struct aiMesh *mesh) {
    uint32_t material;
    if (!find_material(&material, import, mesh->mMaterialIndex)) return false;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        for (unsigned k = 0; k < face->mNumIndices; k++)
            if (face->mIndices[k] >= mesh->mNumVertices)
                return fail(import->ctx, GN_SCENE, "%s: face %u of mesh '%s' has vertex %u, expected at most %u", import->path, i,
                            excerpt_word(mesh->mName.data).text, face->mIndices[k], mesh->mNumVertices - 1);
        for (unsigned k = 2; k < face->mNumIndices; k++) {
            uint32_t *triangle = import->mesh->indices + 3 * import->triangles;
            triangle[0] = (uint32_t)import->vertices + face->mIndices[0];
            triangle[1] = (uint32_t)import->vertices + face->mIndices[k - 1];
            triangle[2] = (uint32_t)import->vertices + face->mIndices[k];
            import->mesh->materials[import->triangles++] = material;
        }
    }
    return true;
}

static bool fill_mesh(struct import *import, const struct aiMesh *mesh, const struct transform *to_world) {
    uint32_t bad;
    const uint32_t first = (uint32_t)import->vertices;
    if (mesh->mMaterialIndex >= import->scene->mNumMaterials)
        return fail(import->ctx, GN_SCENE, "%s: mesh '%s' has material %u, expected less than %u", import->path,
                    excerpt_word(mesh->mName.data).text, mesh->mMaterialIndex, import->scene->mNumMaterials);
    if (!fill_vertices(import, mesh) || !fill_triangles(import, mesh)) return false;
    import->vertices += mesh->mNumVertices;
    if (memcmp(to_world, &transform_identity, sizeof *to_world) == 0) return true;
    return mesh_transform(import->mesh, to_world, first, mesh->mNumVertices, &bad) ||
           fail(import->ctx, GN_SCENE, "%s: the node of mesh '%s' takes vertex %u out of the range of fp32, expected smaller numbers",
                import->path, excerpt_word(mesh->mName.data).text, bad - first);
}

// ---------------------------------------------------------------------------------------------------------------- the tree

static bool names_equal(const struct aiString *a, const struct aiString *b) {
    return a->length == b->length && memcmp(a->data, b->data, a->length) == 0;
}

static void note_transforms(struct import *import, const struct aiNode *node, const struct transform *to_world) {
    for (unsigned i = 0; i < import->camera_count; i++)
        if (names_equal(&import->scene->mCameras[i]->mName, &node->mName)) import->cameras[i] = *to_world;
    for (unsigned i = 0; i < import->light_count; i++)
        if (names_equal(&import->scene->mLights[i]->mName, &node->mName)) import->lights[i] = *to_world;
}

static bool walk(struct import *import, const struct aiNode *node, const struct transform *parent, unsigned depth) {
    const struct transform own = node_transform(node), to_world = transform_product(parent, &own);
    if (depth > MOST_DEPTH) return fail(import->ctx, GN_SCENE, "%s: nodes lie more than %d deep, expected fewer", import->path, MOST_DEPTH);
    if (import->filling) note_transforms(import, node, &to_world);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= import->scene->mNumMeshes)
            return fail(import->ctx, GN_SCENE, "%s: a node has mesh %u, expected less than %u", import->path, node->mMeshes[i],
                        import->scene->mNumMeshes);
        const struct aiMesh *mesh = import->scene->mMeshes[node->mMeshes[i]];
        if (!(import->filling ? fill_mesh(import, mesh, &to_world) : count_mesh(import, mesh))) return false;
    }
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!walk(import, node->mChildren[i], &to_world, depth + 1)) return false;
    return true;
}

// ----------------------------------------------------------------------------------------------------- cameras and lights

static bool take_cameras(struct model *out, struct import *import) {
    out->cameras = array_alloc(import->ctx, import->camera_count, sizeof *out->cameras, "cameras");
    if (!out->cameras) return false;
    for (unsigned i = 0; i < import->camera_count; i++) {
        if (look_camera(&out->cameras[out->camera_count], import->scene->mCameras[i], &import->cameras[i]))
            out->camera_count++;
        else
            notify(import->ctx, GN_LEVEL_WARNING, "%s: camera %u cannot be used; it is left out", import->path, i);
    }
    return true;
}

static bool take_lights(struct model *out, struct import *import) {
    out->lights = array_alloc(import->ctx, import->light_count, sizeof *out->lights, "lights");
    if (!out->lights) return false;
    for (unsigned i = 0; i < import->light_count; i++) {
        if (look_light(&out->lights[out->light_count], import->scene->mLights[i], &import->lights[i]))
            out->light_count++;
        else
            notify(import->ctx, GN_LEVEL_WARNING, "%s: light %u is no point light that can be used; it is left out", import->path, i);
    }
    if (import->scene->mNumLights > import->light_count)
        notify(import->ctx, GN_LEVEL_WARNING, "%s: has %u lights; only %u are used", import->path, import->scene->mNumLights,
               import->light_count);
    return true;
}

static bool prepare_look(struct import *import) {
    const struct aiScene *scene = import->scene;
    import->camera_count = scene->mNumCameras < MOST_CAMERAS ? scene->mNumCameras : MOST_CAMERAS;
    import->light_count = scene->mNumLights < MOST_LIGHTS ? scene->mNumLights     : MOST_LIGHTS;
    import->lights = array_alloc(import->ctx, import->light_count, sizeof *import->lights, "lights");
    import->material_numbers = array_alloc(import->ctx, scene->mNumMaterials, sizeof *import->material_numbers, "materials");
    if (!import->lights || !import->material_numbers) return false;
    for (unsigned i = 0; i < import->camera_count; i++) import->cameras[i] = transform_identity;
    for (unsigned i = 0; i < import->light_count; i++) import->lights[i] = transform_identity;
    for (unsigned i = 0; i < scene->mNumMaterials; i++) import->material_numbers[i] = NO_MATERIAL;
    return true;
}

// A single material for all needs no list; if it is the made-up one, the file has none.
static void take_materials(struct model *out, struct import *import) {
    const struct scene_material *materials = import->materials.items.items;
    if (import->materials.items.count <= 1) {
        free(out->mesh.materials);
        out->mesh.materials = NULL;
    }
    if (import->materials.items.count != 1 || strcmp(materials[0].name, DEFAULT_MATERIAL) != 0)
        material_table_take(&import->materials, &out->materials, &out->material_count);
}

// --------------------------------------------------------------------------------------------------------------- the scene

static bool take_scene(struct model *out, struct import *import) {
    struct context *ctx = import->ctx;
    const struct aiNode *root = import->scene->mRootNode;
    import->mesh = &out->mesh;
    if (root && !walk(import, root, &transform_identity, 0)) return false;
    if (import->triangles == 0) return fail(ctx, GN_SCENE, "%s: has no triangles, expected at least one", import->path);
    if (!mesh_init(&out->mesh, ctx, import->vertices, import->triangles, import->has_normals) || !prepare_look(import)) return false;
    out->mesh.materials = array_alloc(ctx, import->triangles, sizeof *out->mesh.materials, "materials of triangles");
    if (!out->mesh.materials) return false;
    import->filling = true;
    import->vertices = import->triangles = 0;
    if (!walk(import, root, &transform_identity, 0) || !take_cameras(out, import) || !take_lights(out, import)) return false;
    take_materials(out, import);
    return true;
}

static const struct aiScene *read_scene(struct context *ctx, const char *path) {
    if (aiIsExtensionSupported(strrchr(path, '.') ? strrchr(path, '.') : "") != AI_TRUE) {
        fail(ctx, GN_SCENE,
             "%s: is no scene (.json) and no model that can be read, expected .obj, .ply, .stl, .gltf, .glb, or what Assimp reads", path);
        return NULL;
    }
    if (!progress(ctx, "scene", 0, -1)) return NULL;
    const struct aiScene *scene = aiImportFile(path, 0);
    if (!scene) fail(ctx, GN_SCENE, "%s: Assimp cannot read it: %s", path, aiGetErrorString());
    return scene;
}

bool model_load_assimp(struct model *out, struct context *ctx, const char *path) {
    *out = (struct model){0};
    struct import import = {.ctx = ctx, .path = path, .materials = MATERIAL_TABLE};
    import.scene = read_scene(ctx, path);
    if (!import.scene) return false;
    const bool done = take_scene(out, &import);
    aiReleaseImport(import.scene);
    material_table_finish(&import.materials);
    free(import.material_numbers);
    free(import.lights);
    if (!done) model_finish(out);
    return done;
}
