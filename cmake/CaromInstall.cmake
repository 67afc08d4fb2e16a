# cmake --install: libraries, headers, the CMake package and the pkg-config files. See
# docs/guide/embedding.md.
include(CMakePackageConfigHelpers)

set(carom_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
install(FILES ${PROJECT_BINARY_DIR}/include/carom/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/carom)

install(TARGETS carom_kernel carom_engine carom_games EXPORT carom ARCHIVE)
if(CAROM_BUILD_C_LIBRARY)
  install(TARGETS carom_c EXPORT carom LIBRARY)
endif()
install(EXPORT carom NAMESPACE carom:: FILE carom-targets.cmake DESTINATION ${carom_package_dir})
# The renderer has more dependencies, so it is a separate component.
if(CAROM_BUILD_RENDER)
  install(TARGETS carom_render EXPORT carom_render ARCHIVE)
  install(EXPORT carom_render NAMESPACE carom:: FILE carom-render-targets.cmake
    DESTINATION ${carom_package_dir})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/caromConfig.cmake.in
  ${PROJECT_BINARY_DIR}/caromConfig.cmake INSTALL_DESTINATION ${carom_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/caromConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/caromConfig.cmake ${PROJECT_BINARY_DIR}/caromConfigVersion.cmake
  DESTINATION ${carom_package_dir})

# Relative to the .pc file, so that the whole installation can be moved.
file(RELATIVE_PATH carom_pc_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
set(carom_pc_files carom-engine)
if(CAROM_BUILD_C_LIBRARY)
  list(APPEND carom_pc_files carom)
endif()
foreach(name ${carom_pc_files})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
include(CaromCps)
