# The reference of the public headers, with the README and the guide, as pages: cmake --build build --target docs
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/docs")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE README.md)
set(DOXYGEN_FULL_PATH_NAMES YES)
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_STRIP_FROM_INC_PATH packing/include gpu/include plugin/include)
set(DOXYGEN_TOC_INCLUDE_HEADINGS 2)
set(DOXYGEN_GENERATE_TREEVIEW YES)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_SORT_MEMBER_DOCS NO)
set(DOXYGEN_IMAGE_PATH "${PROJECT_SOURCE_DIR}")
# The precision of Bullet is an inline namespace that nobody writes.
set(DOXYGEN_INPUT_FILTER "sed s/.*namespace.INNERSPHERE_BULLET_PRECISION.*//")
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(docs README.md plugin/README.md examples/README.md CONTRIBUTING.md CHANGELOG.md
  packing/include gpu/include plugin/include
  WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" COMMENT "Writing build/docs/html/index.html")
