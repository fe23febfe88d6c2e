#include "restir/domain_store.h"

namespace mote {

DomainStore::DomainStore(int width, int height)
    : headers_(width, height),
      tiles_across_(static_cast<size_t>((width + image_tile_size - 1) / image_tile_size)),
      edges_(tiles_across_ * static_cast<size_t>((height + image_tile_size - 1) / image_tile_size))
{
}

void DomainStore::store(int x, int y, const PixelDomain& domain)
{
    Header& header = headers_.at(x, y);
    std::vector<Edge>& edges = edges_[tile_of(x, y)];
    const RayBins& bins = domain.bins;
    header = {domain.ray, bins.t0, bins.depth(), bins.count, static_cast<uint32_t>(edges.size())};
    if (bins.empty()) return;
    for (int k = 0; k <= bins.count; ++k) {
        edges.push_back({bins.s[k], bins.tau[k], domain.cdf[k]});
    }
}

void DomainStore::load(int x, int y, PixelDomain& domain) const
{
    const Header& header = headers_.at(x, y);
    domain.ray = header.ray;
    domain.surface.reset();  // samples in media do not need it
    RayBins& bins = domain.bins;
    bins.t0 = header.t0;
    bins.count = header.count;
    domain.cdf[0] = 0.0f;
    if (bins.empty()) return;
    const Edge* edges = edges_[tile_of(x, y)].data() + header.first;
    for (int k = 0; k <= bins.count; ++k) {
        bins.s[k] = edges[k].s;
        bins.tau[k] = edges[k].tau;
        domain.cdf[k] = edges[k].cdf;
    }
}

size_t DomainStore::memory_bytes() const
{
    size_t bytes = headers_.size() * sizeof(Header);
    for (const std::vector<Edge>& edges : edges_) bytes += edges.capacity() * sizeof(Edge);
    return bytes;
}

}  // namespace mote
