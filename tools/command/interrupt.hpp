#pragma once
/// Ctrl-C and its like.

namespace plumb::command {

/// From here on SIGINT, SIGTERM and SIGHUP remove what is staged (StagedFolder), say so in one sentence and end the program with 128 and the
/// signal's number. Call it before other threads begin; calling it again does nothing.
void remove_staging_when_interrupted();

}  // namespace plumb::command
