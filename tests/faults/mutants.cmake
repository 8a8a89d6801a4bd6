# Drivers that are broken on purpose, each in one place and for one row of the fault matrix: a copy
# of the driver's sources in which an expression gives way to a broken one while its mutant is the
# active one. The product's own sources stay as they are.
set(mutant_files "")
set(mutant_table "")
set(mutant_count 0)

# In the driver's FILE the expression SOUND, which must be there exactly once, becomes BROKEN; the
# script ROW must then fail at DOOR (inproc or usb).
function(mutant row door file sound broken)
    if(NOT file IN_LIST mutant_files)
        file(READ ${CMAKE_SOURCE_DIR}/driver/${file} text)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
            ${CMAKE_SOURCE_DIR}/driver/${file})
        list(APPEND mutant_files ${file})
        set(mutant_files ${mutant_files} PARENT_SCOPE)
    else()
        get_property(text GLOBAL PROPERTY mutated_${file})
    endif()
    string(FIND "${text}" "${sound}" first)
    string(FIND "${text}" "${sound}" last REVERSE)
    if(first EQUAL -1 OR NOT first EQUAL last)
        message(FATAL_ERROR "mutant of row ${row}: driver/${file} must have exactly once: ${sound}")
    endif()
    string(REPLACE "${sound}" "(fault_test::mutant(${mutant_count}) ? (${broken}) : (${sound}))"
        text "${text}")
    set_property(GLOBAL PROPERTY mutated_${file} "${text}")
    string(APPEND mutant_table "    Mutant{\"${row}\", Door::${door}, \"driver/${file}\",\n"
        "           R\"(${sound})\",\n           R\"(${broken})\"},\n")
    set(mutant_table "${mutant_table}" PARENT_SCOPE)
    math(EXPR mutant_count "${mutant_count} + 1")
    set(mutant_count ${mutant_count} PARENT_SCOPE)
endfunction()

mutant(F01 inproc watched_transport.cpp [[!probed.answers]] [[false]])
mutant(F02 inproc watched_transport.cpp [[done || !bootId_]] [[true]])
mutant(F03 inproc link.cpp [[ident().bootId != boot]] [[true]])
mutant(F03 inproc rig_comeback.cpp [[bootId() == boot]] [[false]])
mutant(F04 inproc rig_comeback.cpp [[!gap.sameBoot]] [[false]])
mutant(F05 inproc link.cpp [[there.serial != strings().serial]] [[false]])
mutant(F06-third inproc rig_comeback.cpp [[lost.deviceStatus == status::kLink]] [[false]])
mutant(F06 inproc collector.cpp [[late ? overdue(armed.expected.frames) : assembler_.lost()]]
    [[std::vector<MissingChunks>{}]])
mutant(F07 inproc watched_transport.cpp [[now() - heard_ >= kSilence]] [[false]])
mutant(F08 inproc protocol/chunk.cpp
    [[transfer.size() - seen.headerBytes != header.length]] [[false]])
mutant(F09 inproc assembler.cpp [[static_cast<std::uint32_t>(jump)]] [[0U]])
mutant(F10 inproc protocol/chunk.cpp [[get<std::uint32_t>(transfer, 48) != crc]] [[false]])
mutant(F10-for-good inproc rig.cpp [[progress.recaptures == kRecaptures]]
    [[progress.recaptures == 2 * kRecaptures]])
mutant(F11 inproc capture_frames.cpp [=[begun->second.have[header.chunkIndex]]=] [[false]])
mutant(F12 inproc capture_frames.cpp [[header.captureId == expected_.captureId]] [[true]])
mutant(F13 inproc link.cpp [[ack && !*ack]] [[false]])
mutant(F14 inproc link.cpp [[event.sequence != lastEvent_ + 1]] [[false]])
mutant(F15 usb usb_stream_transport.cpp [[code == LIBUSB_ERROR_NO_MEM]] [[false]])
mutant(F06 usb usb_stream_transport.cpp
    [[libusb_clear_halt(rig_.handle.get(), rig_.interfaces.bulkIn)]] [[0]])
mutant(F06-error usb usb_stream_transport.cpp [[stalled ? 0 : askWhetherThere()]]
    [[stalled ? 0 : LIBUSB_ERROR_IO]])
mutant(F15-none usb usb_stream_transport.cpp
    [[steadyNow() - *starvedSince_ >= kMemoryLimit]] [[true]])
mutant(F16-until-reset inproc watched_transport.cpp [[port == Port::Reset]] [[false]])
mutant(F17-drift inproc frame_plan.cpp [[(bits & validity::kCurrent) == 0]] [[false]])
mutant(F23 inproc frame_plan.cpp
    [[static_cast<std::int32_t>(wire.leader.frameNumber - plan.effectiveFrame) < 0]]
    [[wire.leader.exposureStartUs > (std::uint64_t{1} << 40)]])
mutant(F24 inproc capture_frames.cpp
    [[header.type < ChunkType::Leader || header.type > ChunkType::Aborted]] [[false]])
mutant(F24-major inproc identity.cpp [[theirs.major == ours.major]] [[true]])
mutant(F25 inproc identity.cpp [[ident.maxChunkPayload == 0]] [[false]])

set(mutated_sources "")
foreach(file IN LISTS mutant_files)
    get_property(text GLOBAL PROPERTY mutated_${file})
    get_filename_component(name ${file} NAME_WE)
    set(copy ${CMAKE_CURRENT_BINARY_DIR}/mutants/${name}.cpp)
    file(CONFIGURE OUTPUT ${copy} @ONLY
        CONTENT "#include \"tests/faults/mutant.h\"\n\nnamespace gonio::driver {\nnamespace fault_test = gonio::fault_test;\n}\n\n${text}")
    list(APPEND mutated_sources ${copy})
endforeach()
set(mutants_list ${CMAKE_CURRENT_BINARY_DIR}/mutants/mutants_list.cpp)
file(CONFIGURE OUTPUT ${mutants_list} @ONLY CONTENT "#include \"tests/faults/mutant.h\"

namespace gonio::fault_test {

const std::vector<Mutant>& mutants() {
    static const std::vector<Mutant> all{
${mutant_table}    };
    return all;
}

}  // namespace gonio::fault_test
")
