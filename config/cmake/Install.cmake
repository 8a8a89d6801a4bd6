# `proc` installs as a package: find_package(gonio), target gonio::proc.
get_property(proc_targets GLOBAL PROPERTY GONIO_PROC_TARGETS)
add_library(gonio_proc INTERFACE)
add_library(gonio::proc ALIAS gonio_proc)
set_target_properties(gonio_proc PROPERTIES EXPORT_NAME proc)
target_link_libraries(gonio_proc INTERFACE ${proc_targets})

install(TARGETS gonio_proc ${proc_targets} EXPORT gonioTargets COMPONENT proc
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT gonioTargets NAMESPACE gonio:: COMPONENT proc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
install(DIRECTORY proc COMPONENT proc DESTINATION include/gonio FILES_MATCHING PATTERN "*.h")

include(CMakePackageConfigHelpers)
configure_package_config_file(config/cmake/gonioConfig.cmake.in gonioConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
write_basic_package_version_file(gonioConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gonioConfig.cmake ${CMAKE_BINARY_DIR}/gonioConfigVersion.cmake
    COMPONENT proc DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
install(DIRECTORY config/rigs config/references config/demo COMPONENT program
    DESTINATION share/gonio OPTIONAL)
