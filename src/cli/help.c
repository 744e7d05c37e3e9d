#include "cli/help.h"

#include <stdio.h>
#include <string.h>

#include "cli/wrap.h"

static const struct command commands[] = {
    {
        .name = "render",
        .bit = COMMAND_RENDER,
        .run = command_render,
        .positionals = 1,
        .names = "SCENE",
        .arguments = "SCENE -o FILE",
        .summary = "a picture",
        .about = "Renders SCENE and writes the picture to FILE. SCENE is a scene file (.json, format version 1) or a model (.obj, .ply, "
                 ".stl, .gltf, .glb), which gets a framed camera and a light if it has none. The same seed gives the same picture, to "
                 "the bit, on the same device. FILE is complete or not there: it is written under another name and renamed at the end.",
        .examples = "  gnomon render scenes/demo.json -o demo.png\n"
                    "  gnomon render bunny.obj -o bunny.png --size 1024x1024 --spp 16\n"
                    "  gnomon render scene.json -o scene.exr --aov depth,normal,id\n"
                    "  gnomon render scene.json -o truth.pfm --reference\n"
                    "  gnomon render scene.json -o scene.png --max-error 0.005\n"
                    "  gnomon render scene.json -o scene.png --max-time 10\n"
                    "  gnomon render scene.json -o scene.png --aov error,ulp,undecided\n"
                    "  gnomon render scene.json -o flat.png --disable shadows --json",
    },
    {
        .name = "trace",
        .bit = COMMAND_TRACE,
        .run = command_trace,
        .positionals = 1,
        .names = "SCENE",
        .arguments = "SCENE --rays IN.npy -o OUT.npy",
        .summary = "hits for a batch of rays",
        .about = "Shoots a batch of rays at SCENE and writes what each hits first. Directions need not be unit; t is in units of the "
                 "direction, in the open interval from tmin to tmax. object and primitive are -1 and t is infinite for a miss. Bit 0 of "
                 "flags: the ray was invalid; bit 1: the decision needed more than the first stage of the tier.",
        .examples = "  gnomon trace scene.json --rays rays.npy -o hits.npy\n"
                    "  gnomon trace scene.json --rays rays.npy -o truth.npy --reference\n"
                    "  gnomon trace scene.json --rays rays.npy -o hits.npy --any --repeat 10",
    },
    {
        .name = "verify",
        .bit = COMMAND_VERIFY,
        .run = command_verify,
        .positionals = 1,
        .names = "SCENE",
        .arguments = "SCENE",
        .summary = "the device against the fp64 CPU reference, pixel by pixel",
        .about =
            "Renders SCENE on the device, and on the CPU in fp64 with exact decisions, with the same sample positions and random "
            "numbers, and compares. A pixel differs when a colour channel, in linear light, is off by more than the tolerance (for "
            "values over 1: and by more than 2^-12 of the value). A hit is wrong when the first sample of a pixel hit another "
            "object or primitive, and a tie when it is at the right depth all the same, on a surface that coincides. Where an edge "
            "passes within rounding of a sample either answer is legitimate, so 1 pixel in 10 000 may differ, and 1 in "
            "100 000 more for each further sample (2 in a small picture), and 1 hit in 10 000 may be wrong that is no tie; no value "
            "may be NaN or infinite. Exit code 1 when the check fails.",
        .examples = "  gnomon verify scenes/demo.json\n"
                    "  gnomon verify scene.json --size 256x256 --spp 4 -o difference.png\n"
                    "  gnomon verify scene.json --accuracy fast --json",
    },
    {
        .name = "plan",
        .bit = COMMAND_PLAN,
        .run = command_plan,
        .positionals = 1,
        .names = "SCENE",
        .arguments = "SCENE",
        .summary = "which effects run, which are pruned, and why",
        .about = "Lists the effects that SCENE calls for. What it does not call for is left out of the kernels that run on the device, "
                 "and the picture is the same to the bit. With --measure, of each effect that can be off: what it adds to the time of "
                 "compiling and of tracing; the kernel that is left against the full one; and the buffers against what the device allows.",
        .examples = "  gnomon plan scenes/demo.json\n"
                    "  gnomon plan scenes/demo.json --measure --size 256x128\n"
                    "  gnomon plan scene.json --spp 16 --disable shadows",
    },
    {
        .name = "probe",
        .bit = COMMAND_PROBE,
        .run = command_probe,
        .positionals = 0,
        .names = "",
        .arguments = "",
        .summary = "what this device's arithmetic really does",
        .about = "Calculates with many numbers on the device, easy and nasty ones, and compares with the right results: contraction, "
                 "rounding, division, roots, functions, comparisons, NaN, infinities, denormals, in fp32 and, where there are any, doubles. "
                 "Then says of each accuracy whether the device keeps what it needs. Exit code 1 when an accuracy that the device has "
                 "would be wrong on it; exact and fp64 do not run there.",
        .examples = "  gnomon probe\n"
                    "  gnomon probe --device gpu --json",
    },
    {
        .name = "devices",
        .bit = COMMAND_DEVICES,
        .run = command_devices,
        .positionals = 0,
        .names = "",
        .arguments = "",
        .summary = "Vulkan devices and drivers, and which one would be used",
        .about = "Lists what Vulkan offers on this machine. The device that is marked is the one that the other commands would use with "
                 "the same --device.",
        .examples = "  gnomon devices\n"
                    "  gnomon devices --device cpu\n"
                    "  VK_DRIVER_FILES=/path/to/driver.json gnomon devices",
    },
    {
        .name = "cost",
        .bit = COMMAND_COST,
        .run = command_cost,
        .positionals = 1,
        .names = "SCENE",
        .arguments = "SCENE [-o REPORT.html]",
        .summary = "what accuracy costs in time, on this device",
        .about = "Measures settings on SCENE, one axis at a time (the tiers, the offset rule, accurate against built-in functions, output, "
                 "summation, samples per pixel, sampler) and then together: the median time over rounds in which all take turns, and the "
                 "error against the reference: wrong decisions per million rays, ulp of t, RMSE in linear light, FLIP. It renders a lattice "
                 "of the picture's pixels, as dense as the time allows, and marks the Pareto front: settings that no other beats in both.",
        .examples = "  gnomon cost scenes/demo.json\n"
                    "  gnomon cost scenes/needles.json -o needles.html --seconds 120\n"
                    "  gnomon cost scene.json --size 640x360 --rounds 9 --json",
    },
    {
        .name = "compare",
        .bit = COMMAND_COMPARE,
        .run = command_compare,
        .positionals = 2,
        .names = "A B",
        .arguments = "A B",
        .summary = "two images: metrics, worst pixel, heat map",
        .about = "Compares two images of the same size (.png, .exr, .pfm). Maximum, RMSE and PSNR are over linear light, with the peak "
                 "at 1. FLIP (Andersson et al. 2020) is what a person would notice when switching between the two, 0 to 1.",
        .examples = "  gnomon compare a.png b.png\n"
                    "  gnomon compare a.exr b.exr -o heat.png\n"
                    "  gnomon compare a.png golden.png --max-flip 0.01",
    },
    {
        .name = "stress",
        .bit = COMMAND_STRESS,
        .run = command_stress,
        .positionals = 0,
        .names = "",
        .arguments = "",
        .summary = "the numerically hard cases, each accuracy tier against the exact answer",
        .about = "Runs the hard cases and holds each accuracy tier against exact arithmetic (GMP, MPFR). T: rays and triangles; S: spheres; B: "
                 "boxes and hierarchies; O: rays that leave a surface; H: shading; R: refraction; C: camera and sampling; X: transforms; U: textures; A: "
                 "accumulation and output; V: the exact tier's filter on the worst device that Vulkan allows; W: closed meshes. Cases of rays are varied, too: "
                 "every number by up to 3 ulp, scaled by powers of two, axes turned, vertices rotated, in other hierarchies. Cases without a "
                 "test yet, or of what does not exist, wait. A ray is wrong when it hits something else than it should, in the exact tier also when t, "
                 "u or v is off by more than 1 ulp; it leaks when it passes through a closed surface. Exit code 1 when the exact tier "
                 "is wrong anywhere, or another tier more often than is known of it.",
        .examples = "  gnomon stress\n"
                    "  gnomon stress --case 'T*' --accuracy exact\n"
                    "  gnomon stress --case W01 --rays 100000 --json",
    },
};

static const char *const planned[] = {"bench"};

#define COMMAND_COUNT (sizeof commands / sizeof *commands)

const struct command *command_find(const char *name) {
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(name, commands[i].name) == 0) return &commands[i];
    return NULL;
}

const struct command *command_near(const char *name) {
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (nearly_equal(name, commands[i].name)) return &commands[i];
    return NULL;
}

bool command_planned(const char *name) {
    for (size_t i = 0; i < sizeof planned / sizeof *planned; i++)
        if (strcmp(name, planned[i]) == 0) return true;
    return false;
}

void help_version(void) { printf("gnomon %s\n", gn_version()); }

void help_overview(void) {
    printf("gnomon %s: a headless ray tracer in Vulkan compute shaders\n\n"
           "Usage: gnomon COMMAND ...\n\n",
           gn_version());
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        int column = printf("  %-7s %s", commands[i].name, commands[i].arguments);
        print_wrapped(commands[i].summary, column, 41);
    }
    printf("\ngnomon COMMAND --help says more about one of them.\n"
           "Planned, not in this version: bench.\n\n"
           "Try:\n"
           "  gnomon render scenes/demo.json -o demo.png\n"
           "  gnomon devices\n\n"
           "Exit codes:\n"
           "    0  done, and every output is complete    6  device lost or timed out\n"
           "    1  a check failed                        7  a limit or memory\n"
           "    2  wrong usage                           8  input or output failed\n"
           "    3  scene or asset at fault               9  a fault of gnomon's own\n"
           "    4  no suitable device                   77  skipped\n"
           "    5  shader or pipeline                  130  interrupted\n\n"
           "Environment:\n"
           "  GNOMON_DEVICE          as --device\n"
           "  MESA_SHADER_CACHE_DIR  compiled shaders [a folder in ~/.cache/gnomon]\n");
}

void help_command(const struct command *command) {
    printf("gnomon %s: %s\n\nUsage: gnomon %s%s%s [options]\n\n", command->name, command->summary, command->name,
           *command->arguments ? " " : "", command->arguments);
    print_wrapped(command->about, 0, 0);
    options_print(command->bit);
    printf("\nExamples:\n%s\n", command->examples);
}
