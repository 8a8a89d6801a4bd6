# cmake -D BUILD_DIR=... -D WORK_DIR=... -P program.cmake
# What `cmake --install` puts on a machine with a rig is all there, and the programs find their data.
file(REMOVE_RECURSE ${WORK_DIR})
execute_process(
    COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --component program --prefix ${WORK_DIR}
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(file bin/gonio bin/goniod lib/udev/rules.d/70-gonio.rules lib/systemd/system/goniod.service
             lib/sysusers.d/gonio.conf
             etc/gonio/goniod.toml share/gonio/rigs/minidiff-usb2.toml
             share/gonio/references/white-ptfe.csv)
    if(NOT EXISTS ${WORK_DIR}/${file})
        message(FATAL_ERROR "not installed: ${file}")
    endif()
endforeach()
file(READ ${WORK_DIR}/lib/systemd/system/goniod.service unit)
if(unit MATCHES "@" OR NOT unit MATCHES "ExecStart=/[^\n]*/goniod --config /")
    message(FATAL_ERROR "the service's paths are not filled in:\n${unit}")
endif()
# The installed daemon finds its profile, serves, and ends clean.
set(store ${WORK_DIR}/store)
execute_process(
    COMMAND timeout --preserve-status -s TERM 3 ${WORK_DIR}/bin/goniod
        --config ${WORK_DIR}/etc/gonio/goniod.toml --rig sim --store ${store}
        --socket ${WORK_DIR}/goniod.sock
    COMMAND_ERROR_IS_FATAL ANY)
if(NOT EXISTS ${store}/gonio.db)
    message(FATAL_ERROR "the installed goniod made no store")
endif()
