#include "plumb/data/hash.hpp"

#include <xxhash.h>

#include <cstdio>
#include <new>

namespace plumb {

std::string Hash128::text() const {
  char buffer[33];
  std::snprintf(buffer, sizeof buffer, "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return buffer;
}

struct Hasher::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
  if (!state_->xxh) throw std::bad_alloc();
  XXH3_128bits_reset(state_->xxh);
}
Hasher::~Hasher() = default;

void Hasher::bytes(const void* data, std::size_t size) {
  if (size) XXH3_128bits_update(state_->xxh, data, size);
}

void Hasher::text(std::string_view s) {
  const std::uint64_t n = s.size();
  bytes(&n, sizeof n);
  bytes(s.data(), s.size());
}

Hash128 Hasher::hash() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_->xxh);
  return {h.high64, h.low64};
}

Hash128 hash_of(std::string_view bytes) {
  const XXH128_hash_t h = XXH3_128bits(bytes.data(), bytes.size());
  return {h.high64, h.low64};
}

}  // namespace plumb
