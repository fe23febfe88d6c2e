# mote_layer(name SOURCES... [PUBLIC libs...] [PRIVATE libs...]): one static library per layer, so
# that the link graph enforces the architecture. mote_flags carries what every target shares.
add_library(mote_flags INTERFACE)
target_include_directories(mote_flags INTERFACE ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
target_compile_options(mote_flags INTERFACE
  -march=${MOTE_ARCH} -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Wold-style-cast)
# OpenVDB 10.0.1's reduce bodies do not satisfy oneTBB's C++20 concepts.
target_compile_definitions(mote_flags INTERFACE __TBB_USE_CONSTRAINTS=0 GLM_FORCE_CTOR_INIT
  GLM_FORCE_XYZW_ONLY)
if(MOTE_WERROR)
  target_compile_options(mote_flags INTERFACE -Werror)
endif()
if(MOTE_ASSERTS OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(mote_flags INTERFACE MOTE_ENABLE_ASSERTS)
endif()
if(MOTE_SANITIZE)
  target_compile_options(mote_flags INTERFACE -fsanitize=${MOTE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(mote_flags INTERFACE -fsanitize=${MOTE_SANITIZE})
endif()

function(mote_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(NOT ARG_SOURCES)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE mote_flags ${ARG_PUBLIC})
    return()
  endif()
  add_library(${name} STATIC ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(${name} PUBLIC mote_flags ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

# Compiles every header of the tree alone: a header must not lean on what its users include.
function(mote_validate_headers)
  if(NOT MOTE_VALIDATE_HEADERS)
    return()
  endif()
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}
    ${CMAKE_SOURCE_DIR}/src/*.h ${CMAKE_SOURCE_DIR}/volumes/*.h ${CMAKE_SOURCE_DIR}/particles/*.h)
  set(units)
  foreach(header ${headers})
    string(REPLACE "/" "_" unit ${header})
    set(unit ${CMAKE_BINARY_DIR}/header_check/${unit}.cpp)
    file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${CMAKE_SOURCE_DIR}/${header}\"\n")
    list(APPEND units ${unit})
  endforeach()
  add_library(header_check OBJECT ${units})
  target_link_libraries(header_check PRIVATE mote_flags mote_render mote_image nanovdb oiio
    OpenVDB::openvdb OpenEXR::OpenEXR CLI11::CLI11 nlohmann_json::nlohmann_json
    tomlplusplus::tomlplusplus TinyGLTF::TinyGLTF fmt::fmt spdlog::spdlog)
endfunction()
