#pragma once
/// Ctrl-C and its like.

namespace plumb::command {

/// From here on the signals that end a program, but for those of its own faults, remove what is
/// staged (StagedFolder), say so in one sentence and end the program with 128 and the signal's
/// number. A pipe that nobody reads and a file that gets too large are errors of the write instead,
/// each with its own sentence. Call it before other threads begin; calling it again does nothing.
void remove_staging_when_interrupted();

}  // namespace plumb::command
