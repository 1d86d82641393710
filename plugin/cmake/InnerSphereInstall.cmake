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
include(InnerSpherePkgConfig)

# Texts keep their places beside each other, so that their links lead somewhere. `copyright` is where Debian looks.
if(CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR)
  set(innersphere_doc_dir "${CMAKE_INSTALL_DATAROOTDIR}/doc/innersphere")
  install(FILES LICENSE README.md CHANGELOG.md DESTINATION "${innersphere_doc_dir}")
  install(FILES LICENSE DESTINATION "${innersphere_doc_dir}" RENAME copyright)
  install(FILES plugin/README.md DESTINATION "${innersphere_doc_dir}/plugin")
  install(FILES plugin/python/README.md DESTINATION "${innersphere_doc_dir}/plugin/python")
  install(FILES examples/hello_bullet.cpp examples/pile.png DESTINATION "${innersphere_doc_dir}/examples")
  include(InnerSpherePackage)
endif()
