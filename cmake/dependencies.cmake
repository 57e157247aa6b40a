# The packages that the library stands on, for the options SFUMATO_GL, SFUMATO_OPENVDB and SFUMATO_OPENIMAGEIO:
# found by the build, and again by whoever links to what it installed.
include(CMakeFindDependencyMacro)

find_dependency(fmt)
find_dependency(spdlog)
find_dependency(TBB)
find_dependency(TinyGLTF)
find_dependency(nlohmann_json)

if(SFUMATO_GL)
  find_dependency(PkgConfig)
  pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
endif()
if(SFUMATO_OPENVDB)
  list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
  find_dependency(OpenVDB)
endif()
if(SFUMATO_OPENIMAGEIO)
  find_dependency(OpenImageIO)
  # Debian's package names OpenCV's headers, which need not be there; CMake takes that for an error.
  foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
    get_target_property(folders OpenImageIO::OpenImageIO ${property})
    list(FILTER folders EXCLUDE REGEX "opencv")
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${folders}")
  endforeach()
endif()
