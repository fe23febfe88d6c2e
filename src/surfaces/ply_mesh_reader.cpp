#include <optional>

#include "particles/ply_rows.h"
#include "surfaces/load_mesh.h"
#include "surfaces/triangulate.h"

namespace mote {
namespace {

/// Groups of properties that go together: all of a group or none of it.
struct Group {
    int first;  ///< place among a vertex' values
    std::vector<const char*> names;
};
constexpr int value_count = 8;
constexpr int first_normal = 3;
constexpr int first_uv = 6;

const std::vector<Group>& groups()
{
    static const std::vector<Group> list = {{0, {"x", "y", "z"}},
                                            {first_normal, {"nx", "ny", "nz"}},
                                            {first_uv, {"s", "t"}},
                                            {first_uv, {"u", "v"}},
                                            {first_uv, {"texture_u", "texture_v"}}};
    return list;
}

/// The property of this name that is one number.
std::optional<size_t> find_number(const PlyElement& element, std::string_view name)
{
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!property.list_count && property.name == name) return i;
    }
    return std::nullopt;
}

/// Where each property goes among a vertex' values; -1: nowhere.
std::vector<int> vertex_targets(const std::string& path, const PlyElement& element)
{
    std::vector<int> targets(element.properties.size(), -1);
    bool is_filled[value_count] = {};
    for (const Group& group : groups()) {
        std::vector<size_t> found;
        for (const char* name : group.names) {
            if (const auto property = find_number(element, name)) found.push_back(*property);
        }
        if (found.size() < group.names.size() || is_filled[group.first]) continue;
        is_filled[group.first] = true;
        for (size_t c = 0; c < found.size(); ++c) {
            targets[found[c]] = group.first + static_cast<int>(c);
        }
    }
    if (!is_filled[0]) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: element \"vertex\" needs the properties x, y and z", path));
    }
    return targets;
}

/// The list of a face's corners.
size_t corner_list(const std::string& path, const PlyElement& element)
{
    for (size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const bool is_named = property.name == "vertex_indices" || property.name == "vertex_index";
        if (property.list_count && is_named) return i;
    }
    throw Error(ExitCode::Input,
                fmt::format("{}: element \"face\" needs the list \"vertex_indices\"", path));
}

struct Reader {
    InputFile& file;
    PlyFormat format;
    Mesh mesh;
    std::vector<uint32_t> corners;  ///< of all polygons: files may have them before the vertices
    std::vector<size_t> ends;       ///< of each, in corners

    [[nodiscard]] bool is_big_endian() const { return format == PlyFormat::BigEndian; }
    void read_vertices(const PlyElement& element);
    void read_faces(const PlyElement& element);
    void add_faces();
};

void Reader::read_vertices(const PlyElement& element)
{
    const std::vector<int> targets = vertex_targets(file.path(), element);
    const auto has = [&](int value) {
        return std::find(targets.begin(), targets.end(), value) != targets.end();
    };
    const bool has_normals = has(first_normal);
    const bool has_uvs = has(first_uv);
    float values[value_count] = {};
    const auto store = [&](size_t property, double value) {
        if (targets[property] >= 0) values[targets[property]] = static_cast<float>(value);
    };
    const auto finish = [&] {
        mesh.positions.emplace_back(values[0], values[1], values[2]);
        if (has_normals) mesh.normals.emplace_back(values[3], values[4], values[5]);
        if (has_uvs) mesh.uvs.emplace_back(values[6], values[7]);
    };
    if (format == PlyFormat::Ascii) {
        for_each_ply_line(file, element, [&](uint64_t, TextRow& line) {
            walk_ply_line(line, element, store, [](size_t, double) {});
            finish();
        });
        return;
    }
    for (uint64_t i = 0; i < element.count; ++i) {
        walk_ply_row(
            file, element, is_big_endian(),
            [&](size_t property, const unsigned char* bytes) {
                store(property,
                      load_scalar(bytes, element.properties[property].type, is_big_endian()));
            },
            [&](size_t property, uint64_t entries) {
                file.skip(entries * scalar_size(element.properties[property].type));
            });
        finish();
    }
}

void Reader::read_faces(const PlyElement& element)
{
    const size_t list = corner_list(file.path(), element);
    const auto add = [&](double index) {
        if (!(index >= 0.0 && index < 4294967295.0)) {
            throw Error(ExitCode::Input,
                        fmt::format("{}: a face names vertex {}", file.path(), index));
        }
        corners.push_back(static_cast<uint32_t>(index));
    };
    if (format == PlyFormat::Ascii) {
        for_each_ply_line(file, element, [&](uint64_t, TextRow& line) {
            walk_ply_line(
                line, element, [](size_t, double) {},
                [&](size_t property, double index) {
                    if (property == list) add(index);
                });
            ends.push_back(corners.size());
        });
        return;
    }
    const ScalarType type = element.properties[list].type;
    for (uint64_t i = 0; i < element.count; ++i) {
        walk_ply_row(
            file, element, is_big_endian(), [](size_t, const unsigned char*) {},
            [&](size_t property, uint64_t entries) {
                const size_t size = scalar_size(element.properties[property].type);
                if (property != list) {
                    file.skip(entries * size);
                    return;
                }
                for (uint64_t k = 0; k < entries; ++k) {
                    add(load_scalar(file.take(size), type, is_big_endian()));
                }
            });
        ends.push_back(corners.size());
    }
}

void Reader::add_faces()
{
    size_t begin = 0;
    for (const size_t end : ends) {
        add_face(mesh, std::span(corners).subspan(begin, end - begin), file.path());
        begin = end;
    }
}

}  // namespace

Mesh read_ply_mesh(const std::string& path)
{
    InputFile file(path);
    const PlyHeader header = read_ply_header(file);
    Reader reader{file, header.format, {}, {}, {}};
    for (const PlyElement& element : header.elements) {
        check_ply_claim(file, element, header.format);
        if (element.name == "vertex") {
            reader.read_vertices(element);
        } else if (element.name == "face") {
            reader.read_faces(element);
        } else {
            skip_ply_element(file, element, header.format);
        }
    }
    reader.add_faces();
    return std::move(reader.mesh);
}

}  // namespace mote
