#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "particles/particle_set.h"

namespace mote {

/// Appends the bytes of a number, in either byte order.
template <class T>
void append_bytes(std::string& out, T value, bool is_big_endian = false)
{
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (is_big_endian) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

/// Three particles of simple numbers, exact in binary and decimal.
inline ParticleSet sample_particles()
{
    ParticleSet set;
    set.position = {{0.5f, 1.0f, -2.0f}, {1.25f, -3.5f, 4.0f}, {8.0f, 0.0f, 0.125f}};
    set.velocity = {{1.0f, 0.0f, 0.0f}, {0.0f, -2.0f, 0.5f}, {0.25f, 0.5f, 0.75f}};
    set.radius = {0.5f, 0.25f, 0.125f};
    set.mass = {1.0f, 2.0f, 4.0f};
    set.temperature = {300.0f, 1200.5f, 0.0f};
    set.color = {{1.0f, 0.5f, 0.25f}, {0.0f, 1.0f, 0.0f}, {0.125f, 0.25f, 0.75f}};
    set.id = {7, 5'000'000'000, -1};
    set.age = {0.0f, 0.5f, 2.0f};
    return set;
}

enum class SamplePly { Ascii, Little, Big };

/// sample_particles() as PLY, with an element before and one after the vertices, lists in both
/// and one among the vertex properties. Ids are double: PLY has no 64-bit integers.
inline std::string sample_ply(SamplePly kind)
{
    const ParticleSet set = sample_particles();
    const bool is_ascii = kind == SamplePly::Ascii;
    const bool is_big = kind == SamplePly::Big;
    std::string out = "ply\nformat ";
    out += is_ascii ? "ascii" : is_big ? "binary_big_endian" : "binary_little_endian";
    out +=
        " 1.0\ncomment made by a test\nelement face 2\nproperty list uchar int vertex_indices\n"
        "element vertex 3\nproperty float x\nproperty double y\nproperty float z\n"
        "property list uint16 short neighbours\n"
        "property float vx\nproperty float vy\nproperty float vz\nproperty float32 pscale\n"
        "property float mass\nproperty float temperature\nproperty float r\nproperty float g\n"
        "property float b\nproperty double id\nproperty float age\n"
        "element edge 1\nproperty int a\nend_header\n";
    const auto number = [&](auto value) {
        if (is_ascii)
            out += std::to_string(value) + " ";
        else
            append_bytes(out, value, is_big);
    };
    const auto end_row = [&] { out += is_ascii ? "\n" : ""; };
    const auto length = [&](auto value) {  // std::to_string has no overload for small integers
        if (is_ascii)
            out += std::to_string(static_cast<int>(value)) + " ";
        else
            append_bytes(out, value, is_big);
    };
    for (int face = 0; face < 2; ++face) {
        length(uint8_t{3});
        for (int i = 0; i < 3; ++i) number(i);
        end_row();
    }
    for (size_t i = 0; i < set.size(); ++i) {
        number(set.position[i].x);
        number(double{set.position[i].y});
        number(set.position[i].z);
        length(static_cast<uint16_t>(i));
        for (size_t k = 0; k < i; ++k) length(static_cast<int16_t>(k));
        for (int c = 0; c < 3; ++c) number(set.velocity[i][c]);
        number(set.radius[i]);
        number(set.mass[i]);
        number(set.temperature[i]);
        for (int c = 0; c < 3; ++c) number(set.color[i][c]);
        number(static_cast<double>(set.id[i]));
        number(set.age[i]);
        end_row();
    }
    number(0);
    end_row();
    return out;
}

inline std::string sample_csv()
{
    return "# a comment\nP.x,P.y,P.z,vx,vy,vz,pscale,mass,T,\"Cd.r\",Cd.g,Cd.b,id,age,spare\n"
           "0.5,1,-2,1,0,0,.5,1,300,1,0.5,.25,7,0,1\n"
           "1.25,-3.5,+4,0,-2,0.5,0.25,2,1200.5,0,1,0,5000000000,0.5,2\r\n"
           "\n# another\n"
           "8,0e5,125e-3, 0.25 ,0.5,0.75,0.125,4,0,0.125,0.25,0.75,-1,2,3\n";
}

/// A .npy file from its header dictionary and data.
inline std::string npy_file(const std::string& dictionary, const std::string& data, int version = 1)
{
    std::string out = "\x93NUMPY";
    out += static_cast<char>(version);
    out += '\0';
    const std::string header = dictionary + "\n";
    if (version == 1)
        append_bytes(out, static_cast<uint16_t>(header.size()));
    else
        append_bytes(out, static_cast<uint32_t>(header.size()));
    return out + header + data;
}

inline std::string sample_npy(bool is_big)
{
    const ParticleSet set = sample_particles();
    const std::string o = is_big ? "'>" : "'<";
    std::string data;
    for (size_t i = 0; i < set.size(); ++i) {
        for (int c = 0; c < 3; ++c) append_bytes(data, double{set.position[i][c]}, is_big);
        for (int c = 0; c < 3; ++c) append_bytes(data, set.velocity[i][c], is_big);
        data.append(2, 'x');  // padding
        append_bytes(data, set.radius[i], is_big);
        append_bytes(data, set.mass[i], is_big);
        append_bytes(data, set.temperature[i], is_big);
        for (int c = 0; c < 3; ++c) append_bytes(data, set.color[i][c], is_big);
        append_bytes(data, set.id[i], is_big);
        append_bytes(data, set.age[i], is_big);
    }
    return npy_file("{'descr': [('P', " + o + "f8', (3,)), ('v', " + o +
                        "f4', (3,)), ('', '|V2')," + " ('pscale', " + o + "f4'), ('mass', " + o +
                        "f4'), ('temperature', " + o + "f4'), ('Cd', " + o + "f4', (3,)), ('id', " +
                        o + "i8'), ('age', " + o +
                        "f4')], 'fortran_order': False, 'shape': (3,), }",
                    data, is_big ? 2 : 1);
}

}  // namespace mote
