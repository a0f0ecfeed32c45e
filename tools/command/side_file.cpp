#include "side_file.hpp"

#include <algorithm>
#include <fstream>

#include "plumb/data/error.hpp"

namespace plumb::command {
namespace fs = std::filesystem;

void require_elsewhere(const std::vector<SideFile>& files, const fs::path& output) {
  const auto folder = fs::weakly_canonical(output);
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (files[k].file.empty()) continue;
    const auto file = fs::weakly_canonical(files[k].file);
    const std::string place = files[k].option + " " + files[k].file.string() + ": ";
    const auto [end, _] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    if (end == folder.end()) throw Error(place + "lies in the folder for the results, which holds what steps wrote alone; name a file beside it");
    for (std::size_t n = 0; n < k; ++n)
      if (!files[n].file.empty() && fs::weakly_canonical(files[n].file) == file)
        throw Error(place + "is what " + files[n].option + " writes too; name another file");
  }
}

void begin(const SideFile& side) {
  const std::string place = side.option + " " + side.file.string() + ": ";
  std::string first;
  if (std::ifstream earlier(side.file); earlier) std::getline(earlier, first);
  std::error_code error;
  if (fs::exists(side.file, error) && !(fs::is_regular_file(side.file) && (fs::file_size(side.file) == 0 || first.starts_with(side.mark))))
    throw Error(place + "exists and is no " + side.what + " of plumb; name another file");
  std::ofstream out(side.file);
  out.close();
  if (!out) throw Error(place + "cannot be written; name a file in a folder that exists");
}

}  // namespace plumb::command
