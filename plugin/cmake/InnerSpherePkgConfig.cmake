# Files for pkg-config, for builds without CMake. They find the libraries from their own place, so the prefix can be moved.
#   innersphere, innersphere-float64   the plug-in, for each precision of Bullet
#   innersphere-gpu, -packing          overlap queries; packings and their files
#   innersphere-packer                 meshes to packings
set(pc_dir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH pc_to_prefix "/${pc_dir}" "/")

# innersphere_pc(MODULE LIBRARY DESCRIPTION [PUBLIC module...] [PRIVATE module...] [LIBS flag...]): what a static library
# uses inside has to be linked by the program that uses it.
function(innersphere_pc pc_name pc_library pc_description)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE;LIBS" ${ARGN})
  set(pc_libs "")
  set(pc_private "")
  if(BUILD_SHARED_LIBS)
    list(JOIN arg_PRIVATE " " pc_private)
  else()
    list(APPEND arg_PUBLIC ${arg_PRIVATE})
    list(JOIN arg_LIBS " " pc_libs)
  endif()
  list(JOIN arg_PUBLIC " " pc_requires)
  configure_file("${CMAKE_CURRENT_FUNCTION_LIST_DIR}/innersphere.pc.in" "${PROJECT_BINARY_DIR}/pkgconfig/${pc_name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/${pc_name}.pc" DESTINATION "${pc_dir}")
endfunction()

set(cuda_libs "")
if(innersphere_cuda)
  set(cuda_libs "-L${CUDAToolkit_LIBRARY_DIR}" -lcudart_static -ldl -lrt)
endif()
innersphere_pc(innersphere-packing innersphere_packing "Inner-sphere packings and their files")
innersphere_pc(innersphere-gpu innersphere_gpu "Overlap of inner-sphere packings, on the CPU or in CUDA"
  PUBLIC innersphere-packing PRIVATE tbb LIBS ${cuda_libs} -pthread)
if(TARGET innersphere_packer)
  innersphere_pc(innersphere-packer innersphere_packer "Fills meshes with spheres"
    PUBLIC innersphere-packing PRIVATE tbb assimp zlib)
endif()
if(TARGET innersphere_plugin)
  innersphere_pc(innersphere innersphere_plugin "${PROJECT_DESCRIPTION}" PUBLIC innersphere-gpu bullet)
endif()
if(TARGET innersphere_plugin_float64)
  innersphere_pc(innersphere-float64 innersphere_plugin_float64 "${PROJECT_DESCRIPTION} (double precision)"
    PUBLIC innersphere-gpu bullet-float64)
endif()
