#include <algorithm>

#include "core/parallel.h"
#include "restir/cluster_lanes.h"
#include "restir/light_cells.h"
#include "restir/light_cut.h"

namespace mote {
namespace {

/// Blocks of 2^3 cells share one cut.
constexpr int block_edge = 2;

/// Mean of 1/d^2 over a cube of edge h around its centre is about 8/h^2.
float blur2_of(float cell)
{
    return 0.125f * sqr(cell);
}

/// The volume that scatters most at each cell, or at its neighbours if there is nothing; 0 if
/// there is only one.
class MainVolume {
  public:
    explicit MainVolume(const Media& media) : media_(media) {}

    [[nodiscard]] uint32_t at(Vec3 centre, float cell) const
    {
        if (media_.volumes.size() < 2) return 0;
        uint32_t found = 0;
        float most = 0.0f;
        for (size_t i = 0; i < media_.volumes.size(); ++i) {
            const Volume& volume = media_.volumes[i];
            if (!volume.density) continue;
            const GridFrame frame = frames_at(volume, 0.5f).density;
            float sum = 0.0f;
            for (int n = 0; n < 9; ++n) {  // the centre and, around it, corners of a cube
                const Vec3 corner(n & 1 ? 0.75f : -0.75f, n & 2 ? 0.75f : -0.75f,
                                  n & 4 ? 0.75f : -0.75f);
                const Vec3 p = n == 8 ? centre : centre + cell * corner;
                sum += sample_local(*volume.density, Vec3(frame.point(p)));
            }
            sum *= volume.density_scale * luminance(volume.albedo);
            if (sum > most) {
                most = sum;
                found = static_cast<uint32_t>(i);
            }
        }
        return found;
    }

  private:
    const Media& media_;
};

}  // namespace

LightCells::LightCells(const Media& media, std::span<const LocalLight> lights, Vec3 eye,
                       const LightCellsParams& params)
    : clusters_(make_light_clusters(lights)), floor_share_(params.floor)
{
    if (clusters_.ids.empty()) return;
    everything_[1] = clusters_.light_count();
    for (const Volume& volume : media.volumes) phases_.push_back(volume.phase);
    const int most = std::clamp(params.most_clusters, 1, 256);
    const int least = std::min({most, 64, clusters_.light_count()});
    const size_t most_cells =
        std::min(params.most_cells, params.most_entries / static_cast<size_t>(least));
    const SmokeCells smoke = find_smoke_cells(media, params.edge_voxels, most_cells);
    if (smoke.smoke_count == 0) return;
    // More clusters where cells are few; half the entries is enough before cells are.
    const size_t affordable = params.most_entries / 2 / (smoke.smoke_count + smoke.border_count);
    const int most_clusters =
        std::min(std::clamp(static_cast<int>(std::min<size_t>(affordable, 256)), least, most),
                 clusters_.light_count());
    const CoarseExtinction extinction = make_coarse_extinction(media, smoke);
    make_cells(media, smoke, extinction, most_clusters);
    fill_fluence(extinction);
    set_eye(eye);
}

void LightCells::make_cells(const Media& media, const SmokeCells& smoke,
                            const CoarseExtinction& extinction, int most_clusters)
{
    lattice_ = smoke.lattice;
    cell_at_.assign(lattice_.size(), -1);
    // In blocks, so that what shares a cut lies together.
    const bool one_cut = clusters_.light_count() <= most_clusters;
    std::vector<Vec3i> blocks;
    const Vec3i block_count = (lattice_.count + (block_edge - 1)) / block_edge;
    for (int bz = 0; bz < block_count.z; ++bz) {
        for (int by = 0; by < block_count.y; ++by) {
            for (int bx = 0; bx < block_count.x; ++bx) {
                const size_t before = cells_.size();
                for (int n = 0; n < 8; ++n) {
                    const Vec3i c(2 * bx + (n & 1), 2 * by + (n >> 1 & 1), 2 * bz + (n >> 2));
                    if (glm::any(glm::greaterThanEqual(c, lattice_.count))) continue;
                    const size_t position = lattice_.index(c);
                    if (smoke.marks[position] == SmokeCells::Empty) continue;
                    cell_at_[position] = static_cast<int32_t>(cells_.size());
                    Cell cell;
                    cell.position = static_cast<uint32_t>(position);
                    cell.cut = one_cut ? 0 : static_cast<uint32_t>(blocks.size());
                    cells_.push_back(cell);
                }
                if (cells_.size() > before) blocks.emplace_back(bx, by, bz);
            }
        }
    }
    if (one_cut) blocks.resize(1);
    make_cuts(extinction, blocks, most_clusters);
    uint32_t entries = 0;
    for (Cell& cell : cells_) {
        cell.entry = entries;
        entries += cuts_[cell.cut].count;
    }
    const MainVolume main_volume(media);
    parallel_for(cells_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3 centre = lattice_.centre(lattice_.coordinates(cells_[i].position));
            cells_[i].volume = main_volume.at(centre, lattice_.cell);
        }
    });
    fluence_.resize(entries);
    cdf_.resize(entries);
    scattered_.resize(cells_.size());
}

void LightCells::make_cuts(const CoarseExtinction& extinction, const std::vector<Vec3i>& blocks,
                           int most_clusters)
{
    const auto most = static_cast<size_t>(most_clusters);
    std::vector<int> found(blocks.size() * most);
    cuts_.resize(blocks.size());
    const float edge = block_edge * lattice_.cell;
    parallel_for(blocks.size(), 16, [&](size_t begin, size_t end) {
        std::vector<int> cut;
        for (size_t i = begin; i < end; ++i) {
            if (clusters_.light_count() <= most_clusters) {
                cut.clear();
                for (size_t n = 0; n < clusters_.nodes.size(); ++n)
                    if (clusters_.nodes[n].is_leaf()) cut.push_back(static_cast<int>(n));
            } else {
                const Vec3 centre = lattice_.lo + edge * (Vec3(blocks[i]) + 0.5f);
                choose_light_cut(clusters_, extinction, centre, 0.75f * edge, most_clusters, cut);
            }
            cuts_[i].count = static_cast<uint32_t>(cut.size());
            std::copy(cut.begin(), cut.end(),
                      found.begin() + static_cast<std::ptrdiff_t>(i * most));
        }
    });
    for (size_t i = 0; i < cuts_.size(); ++i) {
        Cut& cut = cuts_[i];
        cut.first = static_cast<uint32_t>(nodes_.size());
        for (size_t n = 0; n < cut.count; ++n) {
            const int node = found[i * most + n];
            nodes_.push_back(node);
            begins_.push_back(clusters_.nodes[static_cast<size_t>(node)].begin);
        }
        nodes_.push_back(-1);
        begins_.push_back(clusters_.light_count());
    }
}

/// The clusters of a cut, side by side.
class LightCells::CutLanes {
  public:
    void load(const LightCells& cells, const Cut& cut)
    {
        if (&cut == loaded_) return;
        loaded_ = &cut;
        batches_.assign((cut.count + lane_count - 1) / lane_count, {});
        for (uint32_t n = 0; n < cut.count; ++n) {
            const int node = cells.nodes_[cut.first + n];
            batches_[n / lane_count].set(static_cast<int>(n % lane_count),
                                         cells.clusters_.nodes[static_cast<size_t>(node)]);
        }
    }
    [[nodiscard]] const std::vector<ClusterLanes>& batches() const { return batches_; }

  private:
    const Cut* loaded_ = nullptr;  // neighbours share their cuts
    std::vector<ClusterLanes> batches_;
};

void LightCells::fill_fluence(const CoarseExtinction& extinction)
{
    constexpr int steps = 16;
    const float blur2 = blur2_of(lattice_.cell);
    parallel_for(cells_.size(), 64, [&](size_t begin, size_t end) {
        CutLanes lanes;
        for (size_t i = begin; i < end; ++i) {
            Cell& cell = cells_[i];
            const Cut& cut = cuts_[cell.cut];
            lanes.load(*this, cut);
            const Vec3 x = lattice_.centre(lattice_.coordinates(cell.position));
            float expected = 0.0f;
            float chosen = 0.0f;
            uint32_t n = 0;
            for (const ClusterLanes& batch : lanes.batches()) {
                FluenceLanes fluence;
                eval_fluence(batch, extinction, x, blur2, steps, fluence);
                for (int l = 0; l < lane_count && n < cut.count; ++l, ++n) {
                    fluence_[cell.entry + n] = fluence.weight[l];
                    expected += fluence.expected[l];
                    chosen += fluence.weight[l];
                }
            }
            const float certainty = expected / chosen;
            cell.certainty = certainty > 0.0f && certainty < 1.0f ? certainty : 1.0f;
        }
    });
}

void LightCells::set_eye(Vec3 eye)
{
    parallel_for(cells_.size(), 64, [&](size_t begin, size_t end) {
        CutLanes lanes;
        for (size_t i = begin; i < end; ++i) {
            lanes.load(*this, cuts_[cells_[i].cut]);
            fill_cell(cells_[i], lanes, eye);
        }
    });
    fill_inscatter();
}

void LightCells::fill_cell(const Cell& cell, const CutLanes& lanes, Vec3 eye)
{
    const Vec3 x = lattice_.centre(lattice_.coordinates(cell.position));
    const Cut& cut = cuts_[cell.cut];
    const float blur2 = blur2_of(lattice_.cell);
    const Vec3 to_eye = eye - x;
    const Vec3 wo = to_eye / std::max(glm::length(to_eye), 1e-30f);
    float weight[256];
    float total = 0.0f;
    uint32_t n = 0;
    for (const ClusterLanes& batch : lanes.batches()) {
        Float8 phase;
        eval_phase(batch, x, wo, phases_[cell.volume], blur2, phase);
        for (int l = 0; l < lane_count && n < cut.count; ++l, ++n) {
            const float w = fluence_[cell.entry + n] * phase[l];
            weight[n] = w > 0.0f ? std::min(w, 1e30f) : 0.0f;
            total += weight[n];
        }
    }
    scattered_[static_cast<size_t>(cell_at_[cell.position])] = total * cell.certainty;

    const float known = total > 0.0f ? (1.0f - floor_share_) / total : 0.0f;
    const float left_over = total > 0.0f ? floor_share_ : 1.0f;
    const auto* sums = clusters_.share_sum.data();
    const auto by_power =
        static_cast<float>(0.5 * static_cast<double>(left_over) / clusters_.share_sum.back());
    const float by_count = 0.5f * left_over / static_cast<float>(cut.count);
    const int* begins = begins_.data() + cut.first;
    float sum = 0.0f;
    uint16_t* cdf = cdf_.data() + cell.entry;
    uint32_t before = 0;
    for (n = 0; n < cut.count; ++n) {
        const auto share = static_cast<float>(sums[begins[n + 1]] - sums[begins[n]]);
        sum += known * weight[n] + by_power * share + by_count;
        // Every entry keeps at least one quantum, those that follow included.
        const uint32_t most = 65536 - (cut.count - 1 - n);
        before = std::clamp(static_cast<uint32_t>(std::lround(65536.0f * sum)), before + 1, most);
        cdf[n] = static_cast<uint16_t>(before);
    }
}

void LightCells::fill_inscatter()
{
    if (cells_.empty()) return;
    double sum = 0.0;
    for (const float s : scattered_) sum += static_cast<double>(s);
    const auto mean = static_cast<float>(sum / static_cast<double>(cells_.size()));
    least_inscatter_ = std::max(1e-6f * mean, 1e-20f);
    inscatter_.assign(lattice_.size(), least_inscatter_);
    const size_t strides[3] = {
        1, static_cast<size_t>(lattice_.count.x),
        static_cast<size_t>(lattice_.count.x) * static_cast<size_t>(lattice_.count.y)};
    parallel_for(cells_.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const size_t position = cells_[i].position;
            const Vec3i c = lattice_.coordinates(position);
            float around = 0.0f;
            float count = 0.0f;
            const auto look = [&](size_t neighbour) {
                const int32_t other = cell_at_[neighbour];
                if (other < 0) return;
                around += scattered_[static_cast<size_t>(other)];
                count += 1.0f;
            };
            for (int axis = 0; axis < 3; ++axis) {
                if (c[axis] > 0) look(position - strides[axis]);
                if (c[axis] + 1 < lattice_.count[axis]) look(position + strides[axis]);
            }
            // A node may sit in a clump's shadow while smoke around it is bright.
            const float floor = 0.1f * around / count;  // a cell with smoke or next to it has some
            inscatter_[position] = std::max(std::max(scattered_[i], floor), least_inscatter_);
        }
    });
}

void LightCells::overwrite(const std::function<float(size_t)>& value, Vec3 eye)
{
    for (size_t i = 0; i < fluence_.size(); ++i) fluence_[i] = value(i);
    set_eye(eye);
}

}  // namespace mote
