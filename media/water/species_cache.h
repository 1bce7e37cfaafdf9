#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace uw {

/// The user's folder for caches: XDG_CACHE_HOME, or .cache in HOME; empty if neither is known.
std::filesystem::path user_cache_folder();

/// From now on the results of species_optics are stored in this folder, which is created when
/// needed, and looked up there; empty: in no folder, as initially. Nothing is read or written while
/// inputs are confined (confine_inputs).
void keep_species_in(const std::filesystem::path& folder);

/// Load and store the results of one computation by a text that contains everything on which it
/// depends. Neither throws: what cannot be written is not stored, and a file that is incomplete, or
/// that belongs to another text, is ignored. Any number of processes may use a folder at once.
std::optional<std::vector<double>> kept_results(const std::string& key, std::size_t count);
void keep_results(const std::string& key, const std::vector<double>& results);

}  // namespace uw
