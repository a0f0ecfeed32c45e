#include "../fuzz.hpp"
#include "plumb/slam/io/frame_files.hpp"

using namespace plumb;

/// The list of a folder in which a.pcd and b.pcd lie.
PLUMB_FUZZ_READER(frame_list) {
  fuzz::file_of("", "a.pcd");
  fuzz::file_of("", "b.pcd");
  fuzz::file_of(bytes, "frames.txt");
  for (const io::FrameFile& frame : io::sequence_frames(fuzz::folder()))
    fuzz::require(std::filesystem::is_regular_file(frame.path), "a frame that is listed is a file");
}
