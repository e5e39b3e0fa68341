#pragma once

#include <array>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tet_line_tracker {

/// A member of `Flags` that users switch on by its name.
template <class Flags>
struct NamedFlag {
  const char* name;
  bool Flags::*on;
};

template <class Flags, std::size_t Count>
std::vector<std::string> flagNames(const std::array<NamedFlag<Flags>, Count>& flags) {
  std::vector<std::string> names;
  names.reserve(Count);
  for (const auto& flag : flags) names.emplace_back(flag.name);
  return names;
}

/// Reads "none", "all" or a comma-separated list of names. Throws std::invalid_argument for others, which
/// says that it is no `what`.
template <class Flags, std::size_t Count>
Flags parseFlags(const std::array<NamedFlag<Flags>, Count>& flags, const std::string& what,
                 const std::string& text) {
  Flags result;
  std::istringstream in(text);
  std::string word;
  while (std::getline(in, word, ',')) {
    bool known = word == "none" || word == "all";
    for (const auto& flag : flags) {
      if (word != flag.name && word != "all") continue;
      result.*flag.on = known = true;
    }
    if (known) continue;
    std::string message = what;
    message.append(" \"").append(word).append("\" is not known; known: none, all");
    for (const auto& flag : flags) message.append(", ").append(flag.name);
    throw std::invalid_argument(message);
  }
  return result;
}

/// As parseFlags() reads it.
template <class Flags, std::size_t Count>
std::string flagText(const std::array<NamedFlag<Flags>, Count>& flags, const Flags& value) {
  std::string list;
  for (const auto& flag : flags) {
    if (value.*flag.on) list.append(list.empty() ? "" : ",").append(flag.name);
  }
  return list.empty() ? "none" : list;
}

}  // namespace tet_line_tracker
