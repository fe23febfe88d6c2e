# Every library comes from Debian 12. The order matters: OpenVDB's module folder ships FindTBB,
# FindOpenEXR and FindBlosc that shadow the packages' own configs, so those are found first.
set(CMAKE_FIND_PACKAGE_PREFER_CONFIG ON)
find_package(Threads REQUIRED)
find_package(TBB 2021 CONFIG REQUIRED)
find_package(Imath CONFIG REQUIRED)
find_package(OpenEXR 3.1 CONFIG REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(spdlog CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(tinyobjloader CONFIG REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
find_package(embree 3.13 CONFIG REQUIRED)

# OpenVDB has no config file, and needs libboost-iostreams-dev, which Debian does not pull in.
set(_saved_module_path "${CMAKE_MODULE_PATH}")
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(OpenVDB 10 REQUIRED)
set(CMAKE_MODULE_PATH "${_saved_module_path}")

# NanoVDB is header only; the module's include dir would be wrong for <nanovdb/...>.
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)
add_library(nanovdb INTERFACE)
target_include_directories(nanovdb SYSTEM INTERFACE ${NANOVDB_INCLUDE_DIR})
target_compile_definitions(nanovdb INTERFACE NANOVDB_USE_OPENVDB NANOVDB_USE_TBB NANOVDB_USE_INTRINSICS)
target_link_libraries(nanovdb INTERFACE OpenVDB::openvdb TBB::tbb)

# OpenImageIO by hand: its config needs the command line tools (and so Qt), and its target names
# a folder that its package does not bring. Only the reader plugin links it (see src/image).
find_path(OIIO_INCLUDE_DIR OpenImageIO/imageio.h REQUIRED)
find_library(OIIO_LIBRARY OpenImageIO REQUIRED)
find_library(OIIO_UTIL_LIBRARY OpenImageIO_Util REQUIRED)
add_library(oiio INTERFACE)
target_include_directories(oiio SYSTEM INTERFACE ${OIIO_INCLUDE_DIR})
target_link_libraries(oiio INTERFACE ${OIIO_LIBRARY} ${OIIO_UTIL_LIBRARY} Imath::Imath)
