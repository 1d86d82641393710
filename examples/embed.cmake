# embed_files(OUTPUT NAME FILE ...): a C++ source that defines innersphere::demo::NAME as the text of FILE, for each pair.
function(embed_files output)
  set(source "#include \"replay/embedded_files.hpp\"\n\nnamespace innersphere::demo {\n")
  while(ARGN)
    list(POP_FRONT ARGN name file)
    file(READ "${file}" text)
    string(APPEND source "const std::string_view ${name} = R\"innersphere(${text})innersphere\";\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  endwhile()
  string(APPEND source "}  // namespace innersphere::demo\n")
  # By way of a copy, so that an unchanged text is not compiled again.
  file(WRITE "${output}.new" "${source}")
  configure_file("${output}.new" "${output}" COPYONLY)
endfunction()
