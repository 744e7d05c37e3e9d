// A folder of its own for the driver's shader cache, one for each driver and setting.
//
// Mesa's disk cache does not tell apart everything that changes the code it stores (the vector width, say), and drivers that share one
// folder have been seen to use each other's code: wrong, or a shader that never ends. So the folder's name carries a hash of what tells
// them apart.
#ifndef CLI_CACHE_DIR_H
#define CLI_CACHE_DIR_H

// Sets MESA_SHADER_CACHE_DIR to ${XDG_CACHE_HOME:-~/.cache}/gnomon/mesa-<hash>, and makes that folder; leaves everything alone if the user
// chose a folder or switched the cache off, or if there is no such place to write. To be called before anything of Vulkan.
void cache_dir_choose(void);

#endif
