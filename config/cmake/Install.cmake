# `proc` installs as a package: find_package(gonio), target gonio::proc. The program and the data
# that it reads at run time are the component `program`.
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

# Static libraries hand their third-party libraries on to the consumer's link line, so the package
# has to find them again: exactly those that a folder of proc links.
set(linked_libraries)
foreach(target IN LISTS proc_targets)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    list(APPEND linked_libraries ${libraries})
endforeach()
set(GONIO_FIND_DEPENDENCIES "")
foreach(package IN ITEMS Threads Eigen3 spdlog Ceres Imath OpenEXR PNG nlohmann_json pugixml)
    if(linked_libraries MATCHES "(^|;)${package}::")
        string(APPEND GONIO_FIND_DEPENDENCIES "find_dependency(${package})\n")
    endif()
endforeach()
if(linked_libraries MATCHES "PkgConfig::tomlplusplus")
    string(APPEND GONIO_FIND_DEPENDENCIES "find_dependency(PkgConfig)\n"
        "pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)\n")
endif()

include(CMakePackageConfigHelpers)
configure_package_config_file(config/cmake/gonioConfig.cmake.in gonioConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)
write_basic_package_version_file(gonioConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gonioConfig.cmake ${CMAKE_BINARY_DIR}/gonioConfigVersion.cmake
    COMPONENT proc DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gonio)

if(TARGET gonio)
    # One place for the program in every build tree: scripts need not know where its sources are.
    set_target_properties(gonio goniod PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
    install(TARGETS gonio goniod COMPONENT program)
    install(DIRECTORY config/rigs config/references config/quality config/demo COMPONENT program
        DESTINATION ${CMAKE_INSTALL_DATADIR}/gonio OPTIONAL)
    # For a real rig: who may open it, the daemon as a service, what it is told. Paths in the unit are
    # those of CMAKE_INSTALL_PREFIX at configure time.
    configure_file(config/linux/goniod.service.in goniod.service @ONLY)
    install(FILES ${CMAKE_BINARY_DIR}/goniod.service COMPONENT program
        DESTINATION lib/systemd/system)
    install(FILES config/linux/70-gonio.rules COMPONENT program DESTINATION lib/udev/rules.d)
    install(FILES config/linux/gonio.sysusers COMPONENT program DESTINATION lib/sysusers.d
        RENAME gonio.conf)
    install(FILES config/goniod.toml COMPONENT program
        DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/gonio)
    install(FILES docs/install.md COMPONENT program DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
