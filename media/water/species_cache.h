#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace uw {

/// Where the user's programs keep what they can compute again: XDG_CACHE_HOME, or .cache in HOME;
/// empty if neither is known.
std::filesystem::path user_cache_folder();

/// From now on what species_optics computes is kept in this folder, which is made when it is
/// needed, and looked for there; empty: in no folder, as at the program's beginning. Nothing is
/// read or written while inputs are confined (confine_inputs).
void keep_species_in(const std::filesystem::path& folder);

/// Results of one computation, by the text that holds all it depends on. Neither throws: what
/// cannot be written is not kept, and a file that is not whole, or that belongs to another text, is
/// no result. Any number of processes may use a folder at once.
std::optional<std::vector<double>> kept_results(const std::string& key, std::size_t count);
void keep_results(const std::string& key, const std::vector<double>& results);

}  // namespace uw
