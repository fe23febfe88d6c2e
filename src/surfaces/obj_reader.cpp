#include <istream>
#include <map>
#include <streambuf>
#include <tuple>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tiny_obj_loader.h>

#include "core/text.h"
#include "particles/input_file.h"
#include "particles/text_row.h"
#include "surfaces/load_mesh.h"
#include "surfaces/triangulate.h"

namespace mote {
namespace {

/// Feeds tinyobjloader line by line, so that the file's line number is that of the line at hand
/// whenever it calls back. It reads what is no number as 0, "nan" and "inf" included: lines of
/// numbers are read here.
class ObjLines : public std::streambuf {
  public:
    explicit ObjLines(InputFile& file) : file_(file) {}

    /// Of the v, vn or vt at hand.
    [[nodiscard]] const Vec3& numbers() const { return numbers_; }
    /// Whether lines so far say what faces are made of.
    [[nodiscard]] bool names_materials() const { return names_materials_; }

  protected:
    int_type underflow() override
    {
        std::string_view line;
        if (!file_.next_line(line)) return traits_type::eof();
        line_.assign(line);
        read_numbers();
        line_.push_back('\n');
        setg(line_.data(), line_.data(), line_.data() + line_.size());
        return traits_type::to_int_type(*gptr());
    }

  private:
    void read_numbers()
    {
        TextRow row(file_.path(), file_.line_number(), line_);
        std::string_view token;
        if (!row.next(token)) return;
        names_materials_ |= token == "usemtl";
        if (token != "v" && token != "vn" && token != "vt") return;
        const int count = token == "vt" ? 2 : 3;
        for (int i = 0; i < count; ++i) {
            if (!row.next(token)) {
                row.fail(count == 2 ? "two numbers are needed" : "three numbers are needed");
            }
            numbers_[i] = static_cast<float>(row.number(token));
        }
    }

    InputFile& file_;
    std::string line_;
    Vec3 numbers_{0.0f};
    bool names_materials_ = false;
};

/// Position, normal and texture coordinates that one corner of a face names; -1: none.
using Corner = std::tuple<int64_t, int64_t, int64_t>;

/// A mesh being read. OBJ numbers positions, normals and texture coordinates apart; each
/// combination that occurs is a vertex.
struct ObjBuild {
    const InputFile& file;
    const ObjLines& lines;
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::map<Corner, uint32_t> vertex_of;
    std::vector<uint32_t> polygon;
    Mesh mesh;

    /// 0-based index from OBJ's: 1 is the first, -1 the latest so far.
    [[nodiscard]] int64_t resolve(int index, size_t count, const char* what) const
    {
        const auto size = static_cast<int64_t>(count);
        const int64_t resolved = index > 0 ? index - int64_t{1} : size + index;
        if (index != 0 && resolved >= 0 && resolved < size) return resolved;
        throw Error(ExitCode::Input,
                    fmt::format("{}:{}:1: the face names {} {}, but there are {} so far",
                                file.path(), file.line_number(), what, index, count));
    }

    void add_face(std::span<const tinyobj::index_t> corners)
    {
        polygon.clear();
        for (const tinyobj::index_t& corner : corners) {
            const int64_t p = resolve(corner.vertex_index, positions.size(), "vertex");
            const int64_t n = corner.normal_index == 0
                                  ? -1
                                  : resolve(corner.normal_index, normals.size(), "normal");
            const int64_t t = corner.texcoord_index == 0
                                  ? -1
                                  : resolve(corner.texcoord_index, uvs.size(), "texture point");
            const auto next = static_cast<uint32_t>(mesh.positions.size());
            const auto [entry, is_new] = vertex_of.emplace(Corner(p, n, t), next);
            if (is_new) {
                mesh.positions.push_back(positions[static_cast<size_t>(p)]);
                mesh.normals.push_back(n < 0 ? Vec3(0.0f) : normals[static_cast<size_t>(n)]);
                mesh.uvs.push_back(t < 0 ? Vec2(0.0f) : uvs[static_cast<size_t>(t)]);
            }
            polygon.push_back(entry->second);
        }
        mote::add_face(mesh, polygon, file.path());
    }
};

ObjBuild& build_of(void* user)
{
    return *static_cast<ObjBuild*>(user);
}

}  // namespace

Mesh read_obj(const std::string& path)
{
    InputFile file(path);
    ObjLines lines(file);
    std::istream stream(&lines);
    stream.exceptions(std::ios::badbit);  // hands on what ObjLines throws

    ObjBuild build{file, lines, {}, {}, {}, {}, {}, {}};
    tinyobj::callback_t on;
    on.vertex_cb = [](void* user, float, float, float, float) {
        build_of(user).positions.push_back(build_of(user).lines.numbers());
    };
    on.normal_cb = [](void* user, float, float, float) {
        build_of(user).normals.push_back(build_of(user).lines.numbers());
    };
    on.texcoord_cb = [](void* user, float, float, float) {
        build_of(user).uvs.emplace_back(build_of(user).lines.numbers());
    };
    on.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        build_of(user).add_face({corners, static_cast<size_t>(count)});
    };
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, on, &build, nullptr, nullptr, &error)) {
        throw Error(ExitCode::Input, fmt::format("{}: {}", path, printable(error)));
    }
    if (lines.names_materials()) {
        spdlog::warn(
            "{}: its materials (mtllib, usemtl) are not read; set the object's material, or "
            "export it as .glb",
            printable(path));
    }
    if (build.normals.empty()) build.mesh.normals.clear();
    if (build.uvs.empty()) build.mesh.uvs.clear();
    return std::move(build.mesh);
}

}  // namespace mote
