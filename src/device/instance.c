// The Vulkan instance.
//
// Asking the loader what it offers makes it load every driver once more, which costs as much as the instance itself. So everything is asked
// for at once, and what is refused is left out of the next try: with a loader of 2022 or later the first try succeeds.
#include "device/instance.h"

#include <stdio.h>
#include <string.h>

#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"

// Counts a message of the layer. Warnings count too: there is no call that we may make in a doubtful way.
static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *message, void *user) {
    struct device *device = user;
    (void)severity, (void)types;
    if (device->validation_errors++ == 0) {
        snprintf(device->validation_message, sizeof device->validation_message, "%s", message->pMessage ? message->pMessage : "(no text)");
    }
    return VK_FALSE;
}

// Messages of type GENERAL are the loader's, about drivers that we may not even use; those of type PERFORMANCE are advice. Neither is asked
// for.
static VkDebugUtilsMessengerCreateInfoEXT messenger_info(struct device *device) {
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = device,
    };
}

// Vulkan 1.2 is named so that devices that have it may be asked what 1.2 added; nothing is asked of the others that 1.1 lacks.
static VkResult try_instance(struct device *device, bool portability, bool validate) {
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(device);
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = &(VkValidationFeatureEnableEXT){VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT},
    };
    const char *extensions[3];
    uint32_t count = 0;
    if (portability) extensions[count++] = VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
    if (validate) extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (validate) extensions[count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validate ? &features : NULL,
        .flags = portability ? VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR : 0,
        .pApplicationInfo = &(
            VkApplicationInfo){.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "gnomon", .apiVersion = VK_API_VERSION_1_2},
        .enabledLayerCount = validate ? 1 : 0,
        .ppEnabledLayerNames = &(const char *){VALIDATION_LAYER},
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    return vkCreateInstance(&info, NULL, &device->instance);
}

static VkResult open_instance(struct device *device, struct context *ctx, bool validate) {
    VkResult result = try_instance(device, true, validate);
    if (result == VK_ERROR_LAYER_NOT_PRESENT) {
        notify(ctx, GN_LEVEL_WARNING,
               "the Vulkan validation layer is not installed (package vulkan-validationlayers); going on without it");
        result = try_instance(device, true, validate = false);
    }
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT) result = try_instance(device, false, validate);
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT && validate) {
        notify(ctx, GN_LEVEL_WARNING, "the Vulkan validation layer lacks what is needed here; going on without it");
        result = try_instance(device, false, validate = false);
    }
    device->validating = validate && result == VK_SUCCESS;
    return result;
}

static bool open_messenger(struct device *device, struct context *ctx) {
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(device->instance, "vkCreateDebugUtilsMessengerEXT");
    VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(device);
    VkResult result = create ? create(device->instance, &info, NULL, &device->messenger) : VK_ERROR_EXTENSION_NOT_PRESENT;
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkCreateDebugUtilsMessengerEXT", result);
    return true;
}

bool instance_init(struct device *device, struct context *ctx, bool validate) {
    VkResult result = open_instance(device, ctx, validate);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return fail(ctx, GN_NO_DEVICE, "no Vulkan driver was found; " NO_DRIVER_HINT);
    if (result != VK_SUCCESS) return device_fail(device, ctx, GN_NO_DEVICE, "vkCreateInstance", result);
    return !device->validating || open_messenger(device, ctx);
}

void instance_finish(struct device *device) {
    PFN_vkDestroyDebugUtilsMessengerEXT destroy = NULL;
    if (device->messenger) {
        destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(device->instance, "vkDestroyDebugUtilsMessengerEXT");
    }
    if (destroy) destroy(device->instance, device->messenger, NULL);
    vkDestroyInstance(device->instance, NULL);
    device->messenger = VK_NULL_HANDLE;
    device->instance = VK_NULL_HANDLE;
}
