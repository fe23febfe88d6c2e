#include "surfaces/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

void GltfSource::fail(const std::string& reason) const
{
    throw Error(ExitCode::Input, fmt::format("{}: {}", printable(path, 1000), reason));
}

void GltfSource::fail_index(int index, size_t size, const char* what) const
{
    fail(fmt::format("{} {} does not exist, there are {}", what, index, size));
}

namespace {

size_t component_size(int type)
{
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

int component_count(int type)
{
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

template <class T>
double load(const unsigned char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double load_component(const unsigned char* bytes, int type, bool is_normalized)
{
    const double scale = is_normalized ? 1.0 : 0.0;
    const auto scaled = [&](double value, double largest) {
        return scale > 0.0 ? std::max(value / largest, -1.0) : value;
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return scaled(load<int8_t>(bytes), 127.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return scaled(load<uint8_t>(bytes), 255.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return scaled(load<int16_t>(bytes), 32767.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return scaled(load<uint16_t>(bytes), 65535.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(bytes);
        default:
            return load<float>(bytes);
    }
}

/// Elements in a buffer, all of them inside of it.
struct Elements {
    const unsigned char* first = nullptr;  ///< null: all are 0
    size_t count = 0;
    size_t stride = 0;
    int component_type = 0;
    int components = 0;
    bool is_normalized = false;

    [[nodiscard]] double at(size_t element, int component) const
    {
        if (!first) return 0.0;
        const size_t offset =
            element * stride + static_cast<size_t>(component) * component_size(component_type);
        return load_component(first + offset, component_type, is_normalized);
    }
};

/// Throws unless `elements.count` elements fit into the bytes from `offset` on.
void place(const GltfSource& source, const GltfBytes& bytes, size_t offset, const std::string& what,
           Elements& elements)
{
    const size_t size =
        component_size(elements.component_type) * static_cast<size_t>(elements.components);
    elements.stride = bytes.stride == 0 ? size : bytes.stride;
    if (elements.stride < size) source.fail(fmt::format("{}: its elements overlap", what));
    const bool fits = offset <= bytes.size && size <= bytes.size - offset &&
                      elements.count - 1 <= (bytes.size - offset - size) / elements.stride;
    if (!fits) {
        source.fail(fmt::format("{}: {} elements do not fit into the {} bytes of its buffer view",
                                what, elements.count, bytes.size));
    }
    elements.first = bytes.data + offset;
}

Elements find_elements(const GltfSource& source, int index, int components, const std::string& what)
{
    const tinygltf::Accessor& accessor = source.at(source.model.accessors, index, "accessor");
    Elements elements;
    elements.count = accessor.count;
    elements.component_type = accessor.componentType;
    elements.components = component_count(accessor.type);
    elements.is_normalized = accessor.normalized;
    if (component_size(elements.component_type) == 0 || elements.components == 0) {
        source.fail(fmt::format("{} is of no type that mote reads", what));
    }
    if (elements.components != components) {
        source.fail(fmt::format("{} has {} components, {} are needed", what, elements.components,
                                components));
    }
    if (elements.count == 0) source.fail(fmt::format("{} is empty", what));
    if (accessor.bufferView < 0) {
        if (!accessor.sparse.isSparse || elements.count > total_bytes(source.model)) {
            source.fail(fmt::format("{} has no data", what));
        }
        return elements;
    }
    place(source, view_bytes(source, accessor.bufferView), accessor.byteOffset, what, elements);
    return elements;
}

/// Calls set(element, component, value) for the elements that a sparse accessor replaces.
template <class Set>
void for_each_sparse(const GltfSource& source, const tinygltf::Accessor& accessor,
                     const Elements& base, const std::string& what, Set&& set)
{
    const auto& sparse = accessor.sparse;
    if (!sparse.isSparse || sparse.count <= 0) return;
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
        source.fail(fmt::format("{}: its sparse part starts before its buffer view", what));
    }
    Elements places;
    places.count = static_cast<size_t>(sparse.count);
    places.component_type = sparse.indices.componentType;
    places.components = 1;
    if (component_size(places.component_type) == 0) {
        source.fail(fmt::format("{} is of no type that mote reads", what));
    }
    GltfBytes bytes = view_bytes(source, sparse.indices.bufferView);
    bytes.stride = 0;
    place(source, bytes, static_cast<size_t>(sparse.indices.byteOffset), what, places);
    Elements values = base;
    values.count = places.count;
    bytes = view_bytes(source, sparse.values.bufferView);
    bytes.stride = 0;
    place(source, bytes, static_cast<size_t>(sparse.values.byteOffset), what, values);
    for (size_t i = 0; i < places.count; ++i) {
        const double element = places.at(i, 0);
        if (!(element >= 0.0 && element < static_cast<double>(base.count))) {
            source.fail(fmt::format("{}: its sparse part names element {}, there are {}", what,
                                    element, base.count));
        }
        for (int c = 0; c < base.components; ++c) {
            set(static_cast<size_t>(element), c, values.at(i, c));
        }
    }
}

std::string title(int accessor, const char* what)
{
    return fmt::format("accessor {} ({})", accessor, what);
}

}  // namespace

GltfBytes view_bytes(const GltfSource& source, int buffer_view)
{
    const tinygltf::BufferView& view =
        source.at(source.model.bufferViews, buffer_view, "buffer view");
    const tinygltf::Buffer& buffer = source.at(source.model.buffers, view.buffer, "buffer");
    const bool is_inside = view.byteOffset <= buffer.data.size() &&
                           view.byteLength <= buffer.data.size() - view.byteOffset;
    if (!is_inside) {
        source.fail(fmt::format("buffer view {} lies outside of the {} bytes of its buffer",
                                buffer_view, buffer.data.size()));
    }
    return {buffer.data.data() + view.byteOffset, view.byteLength, view.byteStride};
}

size_t total_bytes(const tinygltf::Model& model)
{
    size_t bytes = 0;
    for (const tinygltf::Buffer& buffer : model.buffers) bytes += buffer.data.size();
    return bytes;
}

size_t element_count(const GltfSource& source, int accessor)
{
    return source.at(source.model.accessors, accessor, "accessor").count;
}

std::vector<glm::vec4> read_vectors(const GltfSource& source, int accessor, int components,
                                    const char* what)
{
    const std::string name = title(accessor, what);
    const Elements elements = find_elements(source, accessor, components, name);
    std::vector<glm::vec4> out(elements.count, glm::vec4(0.0f));
    for (size_t i = 0; i < elements.count; ++i) {
        for (int c = 0; c < components; ++c) out[i][c] = static_cast<float>(elements.at(i, c));
    }
    for_each_sparse(source, source.model.accessors[static_cast<size_t>(accessor)], elements, name,
                    [&](size_t i, int c, double value) { out[i][c] = static_cast<float>(value); });
    return out;
}

std::vector<glm::vec4> read_some_vectors(const GltfSource& source, int accessor, int components,
                                         const char* what, std::span<const uint32_t> wanted)
{
    const std::string name = title(accessor, what);
    const Elements elements = find_elements(source, accessor, components, name);
    if (!wanted.empty() && wanted.back() >= elements.count) {
        source.fail(fmt::format("{} has {} elements, but vertex {} is used", name, elements.count,
                                wanted.back()));
    }
    std::vector<glm::vec4> out(wanted.size(), glm::vec4(0.0f));
    for (size_t i = 0; i < wanted.size(); ++i) {
        for (int c = 0; c < components; ++c) {
            out[i][c] = static_cast<float>(elements.at(wanted[i], c));
        }
    }
    for_each_sparse(source, source.model.accessors[static_cast<size_t>(accessor)], elements, name,
                    [&](size_t element, int c, double value) {
                        const auto found = std::lower_bound(wanted.begin(), wanted.end(), element);
                        if (found == wanted.end() || *found != element) return;
                        const auto i = static_cast<size_t>(found - wanted.begin());
                        out[i][c] = static_cast<float>(value);
                    });
    return out;
}

std::vector<uint32_t> read_indices(const GltfSource& source, int accessor)
{
    const std::string name = title(accessor, "indices");
    const Elements elements = find_elements(source, accessor, 1, name);
    const bool is_unsigned = elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!is_unsigned || elements.is_normalized) {
        source.fail(fmt::format("{} are no unsigned integers", name));
    }
    std::vector<uint32_t> out(elements.count, 0);
    for (size_t i = 0; i < elements.count; ++i) out[i] = static_cast<uint32_t>(elements.at(i, 0));
    for_each_sparse(source, source.model.accessors[static_cast<size_t>(accessor)], elements, name,
                    [&](size_t i, int, double value) { out[i] = static_cast<uint32_t>(value); });
    return out;
}

}  // namespace mote
