# `cmake --install`: the program with its shaders inside, the library, its headers, and a CMake package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/sfumato)
set_target_properties(sfumato_lib PROPERTIES EXPORT_NAME sfumato)
install(TARGETS sfumato RUNTIME)
install(TARGETS sfumato_lib EXPORT sfumato ARCHIVE)
install(EXPORT sfumato FILE sfumatoTargets.cmake NAMESPACE sfumato:: DESTINATION ${package})

foreach(room ${sfumato_rooms} shaders/shared)
  if(room STREQUAL gl AND NOT SFUMATO_GL)
    continue()
  endif()
  file(GLOB headers CONFIGURE_DEPENDS ${room}/*.h)
  if(NOT SFUMATO_GL)
    list(FILTER headers EXCLUDE REGEX "_gpu\\.h$")
  endif()
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sfumato/${room})
endforeach()

configure_package_config_file(cmake/sfumatoConfig.cmake.in sfumatoConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(sfumatoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/dependencies.cmake ${CMAKE_CURRENT_BINARY_DIR}/sfumatoConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/sfumatoConfigVersion.cmake
        DESTINATION ${package})
