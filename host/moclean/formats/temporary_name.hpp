#pragma once

#include <filesystem>
#include <string>

namespace moclean {

/// A hidden name beside a target, `.NAME.xxxx.tmp` with 24 hexadecimal digits: 8 of the machine,
/// 8 of the process, 8 at random. Long names are cut, so that it is legal where NAME is.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Whether a file has such a name of a target of this name, in the same folder.
bool is_temporary_of(const std::filesystem::path& file, const std::string& target_name);

/// Makes a folder of such a name where the system keeps temporary files, for this user alone. It is
/// unfinished (unfinished.hpp), to be removed with what is in it. Throws FileError.
std::filesystem::path make_temporary_folder();

/// Removes from a folder the temporary files, and folders of this user, of processes of this
/// machine that have ended without (killed, or the machine lost its power). Those of other machines
/// that share the folder, and of other containers, cannot be told from those of living ones and
/// stay. Throws nothing.
void remove_left_in(const std::filesystem::path& folder);

/// Likewise from the folder that a new file of this name comes to stand in; nothing for no name.
void remove_left_beside(const std::filesystem::path& file);

}  // namespace moclean
