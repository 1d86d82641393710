# innersphere_library(NAME EXPORT name SOURCES ... HEADERS ...): one library of the project, with the flags, the
# alias InnerSphere::EXPORT and the install rules that all of them share.
function(innersphere_library target)
  cmake_parse_arguments(arg "" "EXPORT" "SOURCES;HEADERS" ${ARGN})
  add_library(${target} ${arg_SOURCES} ${arg_HEADERS})
  add_library(InnerSphere::${arg_EXPORT} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${arg_EXPORT}
    POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  # Public headers are C++17, so that existing Bullet programs can include them; the sources use C++20.
  target_compile_features(${target} INTERFACE cxx_std_17)
  innersphere_flags(${target})
  install(TARGETS ${target} EXPORT InnerSphereTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  foreach(header IN LISTS arg_HEADERS)
    install(FILES "${header}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/innersphere")
  endforeach()
endfunction()

# Flags of every target of the project, libraries and programs alike.
function(innersphere_flags target)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
    CUDA_STANDARD 20 CUDA_STANDARD_REQUIRED ON)
  # Contraction off: the CPU and CUDA backends run the same source and must round alike.
  target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-ffp-contract=off>")
  if(INNERSPHERE_SANITIZE)
    target_compile_options(${target} PRIVATE
      "$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${INNERSPHERE_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all>")
    target_link_options(${target} PUBLIC "-fsanitize=${INNERSPHERE_SANITIZE}")
  endif()
endfunction()
