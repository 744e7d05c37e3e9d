#include "cli/help.h"

#include <stdio.h>
#include <string.h>

static const struct command commands[] = {
    {
        "render", COMMAND_RENDER, 1, "SCENE -o FILE", "SCENE", "a picture", 
        "Renders SCENE and writes the picture to FILE. SCENE is a scene file (.json, format version 1) or a model (.obj, .ply, .stl, .gltf, .glb),\n"
        "which gets a framed camera and a light if it has none. The same seed gives the same picture, to the bit, on the same device.\n"
        "FILE is complete or not there: it is written under another name and renamed at the end.",
        "  gnomon render scenes/demo.json -o demo.png\n"
        "  gnomon render bunny.obj -o bunny.png --size 1024x1024 --spp 16\n"
        "  gnomon render scene.json -o scene.exr --aov depth,normal,id\n"
        "  gnomon render scene.json -o truth.pfm --reference\n"
        "  gnomon render scene.json -o quick.png --disable shadows --json | jq .time_ms",
        command_render,
    },
    {
        "trace", COMMAND_TRACE, 1, "SCENE --rays IN.npy -o OUT.npy", "SCENE", "hits for a batch of rays",
        "Shoots a batch of rays at SCENE and writes what each hits first. Directions need not be unit; t is in units of the direction, in the open\n"
        "interval from tmin to tmax. object and primitive are -1 and t is infinite for a miss. Bit 0 of flags: the ray was invalid; bit 1: the decision\n"
        "needed more than the first stage of the tier.",
        "  gnomon trace scene.json --rays rays.npy -o hits.npy\n"
        "  gnomon trace scene.json --rays rays.npy -o truth.npy --reference\n"
        "  gnomon trace scene.json --rays rays.npy -o hits.npy --any --repeat 10 --json",
        command_trace,
    },
    {
        "verify", COMMAND_VERIFY, 1, "SCENE", "SCENE", "the device against the fp64 CPU reference, pixel by pixel",
        "Renders SCENE on the device and on the CPU in fp64 with exact decisions, with the same sample positions and random numbers, and compares.\n"
        "A pixel differs when a colour channel, in linear light, is off by more than the tolerance (for values over 16: by more than 2^-12 of the\n"
        "value). A hit is wrong when the first sample of a pixel hit another object or primitive. Where an edge passes within rounding of a\n"
        "sample either is legitimate now and then, so 1 pixel in 10 000 may (2 in a small picture), of each kind; no value may be NaN or infinite.\n"
        "Exit code 1 when the check fails.",
        "  gnomon verify scenes/demo.json\n"
        "  gnomon verify scene.json --size 256x256 --spp 4 -o difference.png\n"
        "  gnomon verify scene.json --accuracy fast --json",
        command_verify,
    },
    {
        "plan", COMMAND_PLAN, 1, "SCENE", "SCENE", "which effects run, which are pruned, and why",
        "Lists the effects that SCENE calls for. What it does not call for is left out of the kernels that run on the device.",
        "  gnomon plan scenes/demo.json\n"
        "  gnomon plan scene.json --spp 16 --disable shadows",
        command_plan,
    },
    {
        "devices", COMMAND_DEVICES, 0, "", "", "Vulkan devices and drivers, and which one would be used",
        "Lists what Vulkan offers on this machine. The device that is marked is the one that the other commands would use with the same --device.",
        "  gnomon devices\n"
        "  gnomon devices --device cpu\n"
        "  VK_DRIVER_FILES=/path/to/driver.json gnomon devices",
        command_devices,
    },
    {
        "compare", COMMAND_COMPARE, 2, "A B", "A B", "two images: metrics, worst pixel, heat map",
        "Compares two images of the same size (.png, .exr, .pfm). Maximum, RMSE and PSNR are over linear light, with the peak at 1. FLIP (Andersson et al.\n"
        "2020) is what a person would notice when switching between the two, 0 to 1.",
        "  gnomon compare a.png b.png\n"
        "  gnomon compare a.exr b.exr -o heat.png\n"
        "  gnomon compare a.png golden.png --max-flip 0.01",
        command_compare,
    },
};

static const char *const planned[] = {"cost", "stress", "bench", "probe"};

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
    printf("gnomon %s: a headless ray tracer in Vulkan compute shaders, with an fp64 reference on the CPU\n\n"
           "Usage: gnomon COMMAND ...\n\n", gn_version());
    for (size_t i = 0; i < COMMAND_COUNT; i++) printf("  %-8s%-31s %s\n", commands[i].name, commands[i].arguments, commands[i].summary);
    printf("\ngnomon COMMAND --help says more about one of them. Planned: cost, stress, bench, probe.\n\n"
           "Try:\n"
           "  gnomon render scenes/demo.json -o demo.png\n"
           "  gnomon devices\n\n"
           "Exit codes: 0 done, every output complete; 1 a check failed; 2 wrong usage; 3 scene or asset at fault; 4 no suitable device;\n"
           "5 shader or pipeline; 6 device lost or timed out; 7 a limit or memory; 8 input or output failed; 9 a fault of gnomon's own; 130 interrupted.\n\n"
           "Environment: GNOMON_DEVICE (as --device); MESA_SHADER_CACHE_DIR (else gnomon uses ~/.cache/gnomon).\n");
}

void help_command(const struct command *command) {
    printf("gnomon %s: %s\n\nUsage: gnomon %s%s%s [options]\n\n%s\n", command->name, command->summary, command->name, *command->arguments ? " " : "",
           command->arguments, command->about);
    options_print(command->bit);
    printf("\nExamples:\n%s\n", command->examples);
}
