#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace uw {

/// Patterns for the frame number in file names:
///
///     %d %04d   #  ####   $F $F4   {frame} {frame:04d}
///
/// The number is padded with zeros to the given width, or to as many digits as there are #, and is
/// never truncated. "$F" before a letter and "%4d" (blanks in names) are not patterns.
bool has_frame_pattern(std::string_view name);

/// `name` with `frame` (>= 0) substituted for all patterns.
std::string expand_frame_pattern(std::string_view name, int frame);

/// The file of one frame. Folders that exist under their literal name are taken literally.
std::filesystem::path file_of_frame(const std::filesystem::path& name, int frame);

/// The frames for which a file exists, ascending; the number must be part of the file's own name,
/// not its folder's. Empty if there is no such folder.
std::vector<int> frames_found(const std::filesystem::path& name);

/// Whether the files of two frames differ.
bool differs_by_frame(const std::filesystem::path& name);

/// Git LFS and git-annex leave a small placeholder if the content of a large file has not been
/// fetched. Describes which placeholder `file` is and how to fetch its content, to follow its name
/// ("is a Git LFS pointer ..."); "" if it is none. Also recognises the broken links of git-annex.
std::string stand_in_of(const std::filesystem::path& file);

/// A stamp by which one can tell, without reading it again, whether a file is still the one that
/// was read, unchanged.
struct FileStamp {
    dev_t device = 0;
    ino_t number = 0;
    std::uint64_t bytes = 0;
    std::int64_t modified_s = 0, modified_ns = 0;

    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// The stamp of the file that a name leads to; none if there is no such file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// The stamps of all files from which something was made.
class FileStamps {
  public:
    FileStamps() = default;
    /// Takes the stamps that the files have now: to be called before they are read.
    explicit FileStamps(const std::vector<std::filesystem::path>& files);

    void add(const FileStamps& other);
    /// Whether no file has changed since.
    bool are_current() const;

  private:
    std::vector<std::pair<std::filesystem::path, std::optional<FileStamp>>> stamps_;
};

/// Remembers, until the program ends, that `file` is read for the user: AtomicFile never replaces
/// it. Thread safe.
void remember_input(const std::filesystem::path& file);

/// Who named an input: a scene, which may not be trusted, or the user, whose own files may lie
/// anywhere.
enum class NamedBy { scene, user };

/// Admits an input. All code that opens a file for the user, or has a library open it, calls this
/// before, or calls open_input. It checks that the file is a regular one, since a pipe would wait
/// and a device never end, and that it lies where inputs may (confine_inputs), and remembers it
/// (remember_input). Messages begin with `subject` ("plume.yaml", or the scene entry that names the
/// file, followed by the file) and call what was expected `noun` ("scene", "IES file"). Throws
/// IoError if there is no such file, or it is no regular one; InputError if it lies elsewhere.
/// Thread safe.
void admit_input(const std::filesystem::path& file, const std::string& subject,
                 std::string_view noun, NamedBy named_by = NamedBy::scene);

/// The same, and opens the file. Throws IoError, too, if it may not be read.
std::ifstream open_input(const std::filesystem::path& file, const std::string& subject,
                         std::string_view noun);

/// Opens a file of the program's own, such as one that an earlier run wrote: it is no input, and
/// may be replaced. The stream has failed if there is no such file, or it is no regular one.
std::ifstream open_own_file(const std::filesystem::path& file);

/// From now on, until the program ends, all inputs that a scene names have to lie in the folder of
/// the first of them or below it, after symbolic links: what a scene from a stranger names cannot
/// lead elsewhere.
void confine_inputs();

/// Whether inputs are confined.
bool inputs_are_confined();

/// Whether `file` lies in `folder` or below it, after symbolic links. One that leads nowhere lies
/// outside: what is made there later is not known now.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The files remembered so far that lie, after symbolic links, neither in `folder` nor below it:
/// absolute, in alphabetical order. Thread safe.
std::vector<std::filesystem::path> inputs_outside(const std::filesystem::path& folder);

/// Whether `file` is one of those, by whatever name, symbolic or hard link. Thread safe.
bool is_input(const std::filesystem::path& file);

/// Whether a file of this name exists; a folder is none, nor is what cannot be looked at.
bool is_file(const std::filesystem::path& file);

/// What a file is that is not the text expected, by its first bytes or else by its name, and what
/// to do with it, to follow "...: ": "is a VDB volume, not a valid scene; ..."; "" if nothing
/// tells. `noun`: what was expected, as for read_text_file.
std::string other_format(std::string_view bytes, const std::filesystem::path& file,
                         std::string_view noun);

/// Whether a pipe is accepted as a file, such as one that the user's shell makes on the command
/// line. It is read until it ends; one without a writer is empty.
enum class Pipes { refused, read };

/// The unmodified contents of a text file of at most `max_bytes`, which is admitted as by
/// admit_input. Throws as that does; IoError if the file cannot be read; InputError if it is
/// larger.
std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t max_bytes, std::string_view noun,
                           Pipes pipes = Pipes::refused);

}  // namespace uw
