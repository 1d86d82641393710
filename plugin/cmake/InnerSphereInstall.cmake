# Install and export: find_package(InnerSphere) gives InnerSphere::packing, ::packer, ::gpu, ::plugin (float Bullet) and
# ::plugin_float64.
include(CMakePackageConfigHelpers)
set(innersphere_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/InnerSphere")
install(EXPORT InnerSphereTargets NAMESPACE InnerSphere:: DESTINATION "${innersphere_cmake_dir}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/InnerSphereConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/InnerSphereConfig.cmake" INSTALL_DESTINATION "${innersphere_cmake_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/InnerSphereConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/InnerSphereConfig.cmake" "${PROJECT_BINARY_DIR}/InnerSphereConfigVersion.cmake"
  "${CMAKE_CURRENT_LIST_DIR}/InnerSphereBullet.cmake" DESTINATION "${innersphere_cmake_dir}")
