# A Debian package with the tool, the libraries and their headers: cpack -G DEB, in the build folder.
set(CPACK_PACKAGE_NAME innersphere)
set(CPACK_PACKAGE_VENDOR "InnerSphere developers")
set(CPACK_PACKAGE_CONTACT "InnerSphere developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
  "InnerSphere fills solids with spheres that do not overlap, finds which spheres of two bodies do, and makes contact of it.
The package holds the command-line tool, which packs meshes and runs the scenes, and the libraries for programs that use
Bullet in single or double precision.")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # what the tool links
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libbullet-dev, libtbb-dev")  # what programs with the plug-in need to be built
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libassimp-dev")  # and those that pack
include(CPack)
