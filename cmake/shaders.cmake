# Compiles GLSL kernels to SPIR-V at build time and embeds each as a C array.
#
# gnomon_kernels(target folder file.comp…) writes folder/<name>.h with `const uint32_t kernel_<name>[]`, and folder/<name>.spv
# for spirv-val; whatever the file includes from shaders/ is a dependency.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)

function(gnomon_kernels target folder)
  file(MAKE_DIRECTORY ${folder})
  set(outputs)
  foreach(source ${ARGN})
    get_filename_component(name ${source} NAME_WE)
    set(flags -V --target-env vulkan1.1 --quiet -g0 -I${CMAKE_SOURCE_DIR}/shaders)
    add_custom_command(
      OUTPUT ${folder}/${name}.h ${folder}/${name}.spv
      COMMAND ${GLSLANG_VALIDATOR} ${flags} --depfile ${folder}/${name}.d --vn kernel_${name} -o ${folder}/${name}.h ${source}
      COMMAND ${GLSLANG_VALIDATOR} ${flags} -o ${folder}/${name}.spv ${source}
      DEPENDS ${source} DEPFILE ${folder}/${name}.d
      COMMENT "kernel ${name}" VERBATIM)
    list(APPEND outputs ${folder}/${name}.h ${folder}/${name}.spv)
  endforeach()
  add_custom_target(${target} DEPENDS ${outputs})
endfunction()
