#pragma once

#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "core/math.h"

namespace mote {

/// A glTF file as tinygltf parsed it: nothing in it has been checked. Everything else in this
/// folder goes through the functions below.
struct GltfSource {
    const std::string& path;
    const tinygltf::Model& model;

    /// Throws Error(Input): the file's name, then `reason`.
    [[noreturn]] void fail(const std::string& reason) const;

    /// An element of one of the model's lists. Throws if the index is out of range.
    template <class T>
    const T& at(const std::vector<T>& list, int index, const char* what) const
    {
        if (index < 0 || static_cast<size_t>(index) >= list.size()) {
            fail_index(index, list.size(), what);
        }
        return list[static_cast<size_t>(index)];
    }
    [[noreturn]] void fail_index(int index, size_t size, const char* what) const;
};

/// The values of an accessor of 1 to 4 components, those missing 0; normalised integers in [-1,1].
/// Throws Error(Input) unless they are numbers of this many components that lie in their buffers.
[[nodiscard]] std::vector<glm::vec4> read_vectors(const GltfSource& source, int accessor,
                                                  int components, const char* what);

/// The same of some elements, named in ascending order: primitives may share a large accessor.
[[nodiscard]] std::vector<glm::vec4> read_some_vectors(const GltfSource& source, int accessor,
                                                       int components, const char* what,
                                                       std::span<const uint32_t> elements);

/// Number of elements of an accessor, whatever they are.
[[nodiscard]] size_t element_count(const GltfSource& source, int accessor);

/// Bytes of all buffers together.
[[nodiscard]] size_t total_bytes(const tinygltf::Model& model);

/// As read_vectors, for unsigned integers.
[[nodiscard]] std::vector<uint32_t> read_indices(const GltfSource& source, int accessor);

/// Bytes of a buffer view. Throws Error(Input) if it is not inside of its buffer.
struct GltfBytes {
    const unsigned char* data = nullptr;
    size_t size = 0;
    size_t stride = 0;  ///< 0: the size of an element
};
[[nodiscard]] GltfBytes view_bytes(const GltfSource& source, int buffer_view);

}  // namespace mote
