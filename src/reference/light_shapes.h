// Spheres, triangles and rectangles as lights, sampled evenly over the solid angle that they cover: what shaders/light_sphere.glsl, light_triangle.glsl and
// light_rectangle.glsl do, written in angles. Lengths are in any unit.
#ifndef REFERENCE_LIGHT_SHAPES_H
#define REFERENCE_LIGHT_SHAPES_H

#include <stdbool.h>

// The way from p to a point of the light, and its density per solid angle; false where the light is not seen. From inside a sphere all directions are sampled.
bool ref_sphere_light_sample(double way[3], double *pdf, const double p[3], const double center[3], double radius, const float u[2]);
bool ref_triangle_light_sample(double way[3], double *pdf, const double p[3], const double v[3][3], const float u[2]);

// The corners are v0, v1, v2, v1 + v2 - v0.
bool ref_rectangle_light_sample(double way[3], double *pdf, const double p[3], const double v[3][3], const float u[2]);

// The density for any way to the light; 0 where it is not seen.
double ref_sphere_light_pdf(const double p[3], const double center[3], double radius);
double ref_triangle_light_pdf(const double p[3], const double v[3][3]);
double ref_rectangle_light_pdf(const double p[3], const double v[3][3]);

#endif
