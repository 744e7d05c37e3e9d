// Lobes together: a diffuse part, a highlight, a share of a mirror.
#include "reference/bsdf.h"

#include "reference/lobes.h"
#include "reference/vector.h"
#include "shaders/shared.h"

enum lobe { LOBE_MIRROR, LOBE_HIGHLIGHT, LOBE_DIFFUSE, LOBE_COUNT };

struct ref_bsdf ref_bsdf_make(const struct scene_material *material, uint32_t effects) {
    struct ref_bsdf b = {.model = material->model,
                         .shininess = material->shininess,
                         .metallic = material->metallic,
                         .roughness = material->roughness,
                         .ior = material->ior,
                         .effects = effects};
    for (int i = 0; i < 3; i++) {
        b.diffuse[i] = material->diffuse[i];
        b.specular[i] = material->specular[i];
        b.reflection[i] = material->reflection[i];
    }
    return b;
}

static bool runs(const struct ref_bsdf *b, uint32_t effect) { return b->effects & effect; }
static bool is_ggx(const struct ref_bsdf *b) { return b->model == MODEL_METALLIC_ROUGHNESS && runs(b, EFFECT_GGX); }

// What a lobe sends back, one channel. Of GGX's highlight: head-on.
static double color(const struct ref_bsdf *b, enum lobe lobe, int i) {
    const double metal = is_ggx(b) ? b->metallic : 0;
    switch (lobe) {
    case LOBE_MIRROR:
        if (!runs(b, EFFECT_REFLECTION)) return 0;
        return b->model == MODEL_MIRROR ? b->diffuse[i] : b->reflection[i];
    case LOBE_DIFFUSE:
        if (b->model == MODEL_MIRROR || b->model == MODEL_DIELECTRIC) return 0;
        return runs(b, EFFECT_DIFFUSE) ? b->diffuse[i] * (1 - metal) : 0;
    default:
        if (is_ggx(b)) return (1 - metal) * pow((b->ior - 1) / (b->ior + 1), 2) + metal * b->diffuse[i];
        if (b->model == MODEL_PHONG && runs(b, EFFECT_SPECULAR)) return b->specular[i];
        return b->model == MODEL_BLINN_PHONG && runs(b, EFFECT_BLINN) ? b->specular[i] : 0;
    }
}

void ref_bsdf_eval(double value[3], const struct ref_bsdf *b, const double n[3], const double wo[3], const double wi[3]) {
    double h[3], cosine = vector_dot(n, wi), highlight;
    vector_half(h, wo, wi);
    if (is_ggx(b))
        highlight = lobe_ggx(n, wo, wi, lobe_ggx_alpha(b->roughness));
    else
        highlight = (b->model == MODEL_BLINN_PHONG ? lobe_blinn : lobe_phong)(n, wo, wi, b->shininess);
    for (int i = 0; i < 3; i++) {
        double ks = color(b, LOBE_HIGHLIGHT, i), kd = color(b, LOBE_DIFFUSE, i);
        if (is_ggx(b)) {
            kd *= lobe_matte(ks, vector_dot(n, wo), cosine);
            ks = lobe_schlick(ks, vector_dot(wo, h));
        }
        value[i] = cosine > 0 ? kd * cosine + ks * highlight : 0;
    }
}

// How often a path goes on by each lobe: by the sum over the channels of what it sends back, of a highlight about.
static void chances(double chance[LOBE_COUNT], const struct ref_bsdf *b, double cos_o) {
    double sum = 0;
    for (int lobe = 0; lobe < LOBE_COUNT; lobe++) {
        chance[lobe] = 0;
        for (int i = 0; i < 3; i++) {
            double share = color(b, lobe, i);
            if (lobe == LOBE_HIGHLIGHT && is_ggx(b)) share = cos_o > 0 ? lobe_schlick(share, cos_o) : 0;
            if (lobe == LOBE_HIGHLIGHT && !is_ggx(b)) share *= 2 / (b->shininess + 1);
            if (lobe == LOBE_MIRROR || runs(b, EFFECT_INDIRECT)) chance[lobe] += share;
        }
        sum += chance[lobe];
    }
    for (int lobe = 0; lobe < LOBE_COUNT; lobe++) chance[lobe] = sum > 0 ? chance[lobe] / sum : 0;
}

double ref_bsdf_pdf(const struct ref_bsdf *b, const double n[3], const double wo[3], const double wi[3]) {
    double chance[LOBE_COUNT], highlight, cosine = vector_dot(n, wi);
    if (!(cosine > 0)) return 0;
    chances(chance, b, vector_dot(n, wo));
    if (is_ggx(b))
        highlight = lobe_ggx_pdf(n, wo, wi, lobe_ggx_alpha(b->roughness));
    else
        highlight = (b->model == MODEL_BLINN_PHONG ? lobe_blinn_pdf : lobe_phong_pdf)(n, wo, wi, b->shininess);
    return chance[LOBE_DIFFUSE] * cosine / REF_PI + chance[LOBE_HIGHLIGHT] * highlight;
}

void ref_mirror(double wi[3], const double n[3], const double ng[3], const double wo[3]) {
    vector_mirror(wi, n, wo);
    if (!(vector_dot(wi, ng) > 0)) vector_mirror(wi, ng, wo);
}

static void sample_lobe(double wi[3], const struct ref_bsdf *b, enum lobe lobe, const double n[3], const double wo[3], const float u[2]) {
    if (lobe == LOBE_DIFFUSE)
        lobe_cosine_sample(wi, n, u);
    else if (is_ggx(b))
        lobe_ggx_sample(wi, n, wo, lobe_ggx_alpha(b->roughness), u);
    else
        (b->model == MODEL_BLINN_PHONG ? lobe_blinn_sample : lobe_phong_sample)(wi, n, wo, b->shininess, u);
}

bool ref_bsdf_sample(struct ref_sample *out, const struct ref_bsdf *b, const double n[3], const double ng[3], const double wo[3],
                     const float u[2], float choice) {
    *out = (struct ref_sample){.pdf = 0};
    double chance[LOBE_COUNT];
    chances(chance, b, vector_dot(n, wo));
    if (choice < chance[LOBE_MIRROR]) {
        ref_mirror(out->wi, n, ng, wo);
        for (int i = 0; i < 3; i++) out->weight[i] = color(b, LOBE_MIRROR, i) / chance[LOBE_MIRROR];
        return vector_dot(ng, out->wi) > 0;
    }
    bool highlight = choice < chance[LOBE_MIRROR] + chance[LOBE_HIGHLIGHT] || !runs(b, EFFECT_DIFFUSE);
    sample_lobe(out->wi, b, highlight ? LOBE_HIGHLIGHT : LOBE_DIFFUSE, n, wo, u);
    out->pdf = ref_bsdf_pdf(b, n, wo, out->wi);
    if (!(out->pdf > 0) || !(vector_dot(ng, out->wi) > 0)) return false;
    ref_bsdf_eval(out->weight, b, n, wo, out->wi);
    for (int i = 0; i < 3; i++) out->weight[i] /= REF_PI * out->pdf;
    return true;
}
