#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace mote {

/// 64-bit hash of a sequence of values, for scene hashes and cache keys; the order counts. Not
/// cryptographic: FNV-1a over 64-bit words, each mixed first (splitmix64).
class Hasher {
  public:
    void add(uint64_t value)
    {
        value += 0x9e3779b97f4a7c15u;
        value = (value ^ (value >> 30u)) * 0xbf58476d1ce4e5b9u;
        value = (value ^ (value >> 27u)) * 0x94d049bb133111ebu;
        state_ = (state_ ^ value ^ (value >> 31u)) * 0x100000001b3u;
    }
    void add(double value)
    {
        const double no_sign_of_zero = value + 0.0;
        uint64_t bits = 0;
        std::memcpy(&bits, &no_sign_of_zero, sizeof(bits));
        add(bits);
    }
    void add(std::string_view text)
    {
        add(static_cast<uint64_t>(text.size()));
        for (const char c : text) add(static_cast<uint64_t>(static_cast<unsigned char>(c)));
    }
    [[nodiscard]] uint64_t value() const { return state_ ^ (state_ >> 32u); }

  private:
    uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace mote
