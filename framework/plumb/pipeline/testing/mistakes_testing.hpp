#pragma once
/// For tests of what is told of a wrong pipeline.

#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb::test {

/// The diagnostics' text, with the folder cut off; "" when there is nothing to say.
inline std::string told(const std::string& text, std::vector<std::string> sets = {"input=data"}) {
  const Folder folder;
  Overlay overlay;
  overlay.sets = std::move(sets);
  try {
    read_pipeline(folder.write("a.yaml", text), overlay, registry());
  } catch (const PipelineError& error) {
    std::string all = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (auto at = all.find(prefix); at != std::string::npos; at = all.find(prefix))
      all.erase(at, prefix.size());
    return all;
  }
  return "";
}

/// The cascade with one piece of text exchanged.
inline std::string with(const std::string& old, const std::string& fresh) {
  std::string text = cascade;
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("no '" + old + "' in the cascade");
  return text.replace(at, old.size(), fresh);
}
inline std::string told_with(const std::string& old, const std::string& fresh) {
  return told(with(old, fresh));
}

}  // namespace plumb::test
