# Install rules: headers, library, CMake package, pkg-config file, command.

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/bot2nurbs ${PROJECT_BINARY_DIR}/include/bot2nurbs
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(TARGETS bot2nurbs EXPORT bot2nurbs-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET bot2nurbs_cli)
  install(TARGETS bot2nurbs_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bot2nurbs)
install(EXPORT bot2nurbs-targets NAMESPACE bot2nurbs:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/bot2nurbs-config.cmake.in
                              ${PROJECT_BINARY_DIR}/bot2nurbs-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bot2nurbs-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bot2nurbs-config.cmake
              ${PROJECT_BINARY_DIR}/bot2nurbs-config-version.cmake
        DESTINATION ${package_dir})

# pkg-config: a static library needs its private libraries named.
set(pc_libraries_private "")
get_property(libraries GLOBAL PROPERTY BOT2NURBS_LAYER_LIBRARIES)
list(REMOVE_DUPLICATES libraries)
foreach(library IN LISTS libraries)
  if(library MATCHES "^TK")
    string(APPEND pc_libraries_private " -l${library}")
  elseif(library MATCHES "/lib([^/]+)\\.(a|so)$")
    string(APPEND pc_libraries_private " -l${CMAKE_MATCH_1}")
  elseif(library STREQUAL "TBB::tbb")
    string(APPEND pc_libraries_private " -ltbb")
  elseif(library STREQUAL "fmt::fmt")
    string(APPEND pc_libraries_private " -lfmt")
  endif()
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/cmake/bot2nurbs.pc.in ${PROJECT_BINARY_DIR}/bot2nurbs.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/bot2nurbs.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
