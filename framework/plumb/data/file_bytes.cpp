#include "plumb/data/file_bytes.hpp"

#include <algorithm>
#include <limits>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20;

}  // namespace

void FileBytes::spill(std::string_view bytes) {
  if (!file_) {
    try {
      file_ = std::make_unique<io::ScratchFile>();
      limit_ = piece;
    } catch (const Error&) {  // then it has to be memory
      limit_ = std::numeric_limits<std::size_t>::max();
      memory_.append(bytes);
      return;
    }
  }
  file_->append(memory_.data(), memory_.size());
  memory_ = std::string();
  if (bytes.size() < piece)
    memory_ = bytes;
  else
    file_->append(bytes.data(), bytes.size());
}

void FileBytes::give(const std::function<void(std::string_view)>& take) const {
  const std::uint64_t end = file_ ? file_->size() : 0;
  std::string part;
  for (std::uint64_t at = 0; at < end; at += part.size()) {
    part.resize(static_cast<std::size_t>(std::min<std::uint64_t>(piece, end - at)));
    file_->read(at, part.data(), part.size());
    take(part);
  }
  take(memory_);
}

std::string FileBytes::text() const {
  std::string text;
  text.reserve(size());
  give([&](std::string_view part) { text += part; });
  return text;
}

}  // namespace plumb
