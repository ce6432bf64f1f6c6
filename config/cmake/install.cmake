# What `cmake --install` brings: libraries, headers, the program (tools/), presets, the CMake package.
include(CMakePackageConfigHelpers)
set(PALOC_SHARE_DIR ${CMAKE_INSTALL_DATADIR}/paloc)
set(PALOC_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/paloc)

install(TARGETS paloc_core paloc_map paloc_frontends paloc_config EXPORT paloc_targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(folder core map frontends config)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()

install(FILES ${PROJECT_SOURCE_DIR}/config/default.yaml DESTINATION ${PALOC_SHARE_DIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/sensors DESTINATION ${PALOC_SHARE_DIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/frontends/example DESTINATION ${PALOC_SHARE_DIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/third_party_notes.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The program looks for its presets in ../share/paloc, in the build folder as in an installation.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/config ${CMAKE_BINARY_DIR}/share/paloc SYMBOLIC)

install(EXPORT paloc_targets NAMESPACE paloc:: FILE paloc-targets.cmake
        DESTINATION ${PALOC_CMAKE_DIR})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/paloc-config.cmake.in ${CMAKE_BINARY_DIR}/paloc-config.cmake
  INSTALL_DESTINATION ${PALOC_CMAKE_DIR} PATH_VARS PALOC_SHARE_DIR)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/paloc-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/paloc-config.cmake ${CMAKE_BINARY_DIR}/paloc-config-version.cmake
        DESTINATION ${PALOC_CMAKE_DIR})
