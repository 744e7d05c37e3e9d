#include "reference/light_shapes.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static double length(const double v[3]) { return sqrt(dot(v, v)); }

static void subtract(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

static void cross(double out[3], const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// a·x + b·y
static void combine(double out[3], double x, const double a[3], double y, const double b[3]) {
    for (int i = 0; i < 3; i++) out[i] = x * a[i] + y * b[i];
}

// A zero vector becomes NaN, which everything below takes for a light that is not seen.
static void normalize(double v[3]) {
    const double by = length(v);
    for (int i = 0; i < 3; i++) v[i] /= by;
}

// -------------------------------------------------------------------------------------------------------------- spheres

// (sine·cos 2πv, sine·sin 2πv, cosine) in the frame of T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
static void around(double out[3], const double n[3], double sine, double cosine, double v) {
    const double side = n[2] >= 0 ? 1 : -1, a = -1 / (side + n[2]), c = n[0] * n[1] * a;
    const double t[3] = {1 + side * n[0] * n[0] * a, side * c, -side * n[0]}, b[3] = {c, side + n[1] * n[1] * a, -n[1]};
    for (int i = 0; i < 3; i++) out[i] = sine * (cos(2 * PI * v) * t[i] + sin(2 * PI * v) * b[i]) + cosine * n[i];
}

// Half the angle of the cone of directions that meet the sphere; π/2 from inside.
static double half_cone(double distance, double radius) { return distance > radius ? 0.5 * asin(radius / distance) : 0.5 * PI; }

static double cone_pdf(double half) { return half > 0 ? 1 / (4 * PI * sin(half) * sin(half)) : 0; }

bool ref_sphere_light_sample(double way[3], double *pdf, const double p[3], const double center[3], double radius, const float u[2]) {
    double axis[3], direction[3];
    const double up[3] = {0, 0, 1};
    subtract(axis, center, p);
    const double distance = length(axis), half = half_cone(distance, radius);
    const bool outside = distance > radius;
    if (outside) normalize(axis);
    const double angle = 2 * asin(sqrt(u[0]) * sin(half)); // sin²(angle/2), an area on the unit sphere, is even
    around(direction, outside ? axis : up, sin(angle), cos(angle), u[1]);
    const double along = outside ? distance * cos(angle) : dot(axis, direction);
    // r² less the square of the distance from the center to the line
    const double across = outside ? distance * sin(angle) : sqrt(fmax(0, distance * distance - along * along));
    const double chord = sqrt(fmax(0, (radius - across) * (radius + across)));
    const double t = outside ? along - chord : along + chord;
    for (int i = 0; i < 3; i++) way[i] = t * direction[i];
    *pdf = cone_pdf(half);
    return *pdf > 0 && t > 0;
}

double ref_sphere_light_pdf(const double p[3], const double center[3], double radius) {
    double axis[3];
    subtract(axis, center, p);
    return cone_pdf(half_cone(length(axis), radius));
}

// ------------------------------------------------------------------------------------------------------------ triangles

// A spherical triangle. Angles are taken by the arctangent of a sine and a cosine that both come from differences, so that small ones are right.
struct spherical {
    double a[3], b[3], c[3]; // unit vectors to the corners
    double to_b[3], to_c[3]; // unit tangents at a, of the sides to b and c
    double side_b, side_c;   // the sides from a to b and to c
    double angle;            // between them
    double area;             // the solid angle; 0 where the triangle is not seen
};

// The angle between unit vectors.
static double angle_between(const double a[3], const double b[3]) {
    double minus[3], plus[3];
    combine(minus, 1, a, -1, b);
    combine(plus, 1, a, 1, b);
    return 2 * atan2(length(minus), length(plus));
}

// The unit tangent at a of the way to b.
static void tangent(double out[3], const double a[3], const double b[3]) {
    double chord[3];
    subtract(chord, b, a);
    combine(out, 1, chord, -dot(a, chord), a);
    normalize(out);
}

// From two sides and the angle between them: tan(E/2) = k sin A / (1 + k cos A), k the product of the tangents of half the sides (I. Todhunter, "Spherical
// Trigonometry", 1886, art. 103).
static void spherical_make(struct spherical *out, const double p[3], const double v[3][3]) {
    subtract(out->a, v[0], p);
    subtract(out->b, v[1], p);
    subtract(out->c, v[2], p);
    normalize(out->a);
    normalize(out->b);
    normalize(out->c);
    tangent(out->to_b, out->a, out->b);
    tangent(out->to_c, out->a, out->c);
    out->side_b = angle_between(out->a, out->b);
    out->side_c = angle_between(out->a, out->c);
    out->angle = angle_between(out->to_b, out->to_c);
    const double k = tan(0.5 * out->side_b) * tan(0.5 * out->side_c);
    const double area = 2 * atan2(k * sin(out->angle), 1 + k * cos(out->angle));
    out->area = area > 0 ? area : 0;
}

// The direction for u, as J. Arvo has it ("Stratified sampling of spherical triangles", SIGGRAPH 1995): the arc from b that cuts off the share u[0] of the area meets the
// side from a to c at the distance x, tan(x/2) = sin(E/2) / (tan(side_b/2) sin(A - E/2)), which is the formula above for the part; on the arc, the part of
// 1 - cos, 2 sin² of the half, is u[1].
static void spherical_sample(double out[3], const struct spherical *t, double u, double v) {
    double end[3], along[3];
    const double half = 0.5 * u * t->area;
    const double x = 2 * atan2(sin(half), tan(0.5 * t->side_b) * sin(t->angle - half));
    combine(end, cos(x), t->a, sin(x), t->to_c);
    tangent(along, t->b, end);
    const double y = 2 * asin(sqrt(v) * sin(0.5 * angle_between(t->b, end)));
    combine(out, cos(y), t->b, sin(y), along);
}

// From the direction to the point where it meets the triangle's plane.
static bool reach(double way[3], const double p[3], const double v[3][3]) {
    double e1[3], e2[3], normal[3], corner[3];
    subtract(e1, v[1], v[0]);
    subtract(e2, v[2], v[0]);
    subtract(corner, v[0], p);
    cross(normal, e1, e2);
    const double t = dot(corner, normal) / dot(way, normal);
    for (int i = 0; i < 3; i++) way[i] *= t;
    return t > 0 && isfinite(t);
}

bool ref_triangle_light_sample(double way[3], double *pdf, const double p[3], const double v[3][3], const float u[2]) {
    struct spherical t;
    spherical_make(&t, p, v);
    *pdf = t.area > 0 ? 1 / t.area : 0;
    if (!(t.area > 0)) return false;
    spherical_sample(way, &t, u[0], u[1]);
    return reach(way, p, v);
}

double ref_triangle_light_pdf(const double p[3], const double v[3][3]) {
    struct spherical t;
    spherical_make(&t, p, v);
    return t.area > 0 ? 1 / t.area : 0;
}

// ----------------------------------------------------------------------------------------------------------- rectangles

// The half of a rectangle at its fourth corner, seen from v2.
static void far_half(double out[3][3], const double v[3][3]) {
    memcpy(out[0], v[2], sizeof out[0]);
    memcpy(out[1], v[1], sizeof out[1]);
    for (int i = 0; i < 3; i++) out[2][i] = v[1][i] + (v[2][i] - v[0][i]);
}

bool ref_rectangle_light_sample(double way[3], double *pdf, const double p[3], const double v[3][3], const float u[2]) {
    double far_corners[3][3];
    struct spherical near_part, far_part;
    far_half(far_corners, v);
    spherical_make(&near_part, p, v);
    spherical_make(&far_part, p, (const double(*)[3])far_corners);
    const double area = near_part.area + far_part.area, at = u[0] * area;
    *pdf = area > 0 ? 1 / area : 0;
    if (!(area > 0)) return false;
    if (at < near_part.area) spherical_sample(way, &near_part, at / near_part.area, u[1]);
    else spherical_sample(way, &far_part, fmin(1, (at - near_part.area) / far_part.area), u[1]);
    return reach(way, p, v);
}

double ref_rectangle_light_pdf(const double p[3], const double v[3][3]) {
    double far_corners[3][3];
    struct spherical near_part, far_part;
    far_half(far_corners, v);
    spherical_make(&near_part, p, v);
    spherical_make(&far_part, p, (const double(*)[3])far_corners);
    const double area = near_part.area + far_part.area;
    return area > 0 ? 1 / area : 0;
}
