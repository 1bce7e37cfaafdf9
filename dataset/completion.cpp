#include "dataset/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/image/contact_sheet.h"
#include "core/image/image_file.h"
#include "core/scene/key_path.h"
#include "core/scene/trajectory.h"
#include "dataset/data_card.h"
#include "dataset/formats.h"
#include "dataset/sensor_files.h"
#include "dataset/view.h"

namespace uw {

namespace {

/// The list of a set's views, row by row, as CSV and JSON lines of one array.
class Manifest {
  public:
    explicit Manifest(const DatasetDefinition& definition);

    void add(const ViewRecord& record);

    const std::string& csv() const { return csv_; }
    /// The lists of all views added.
    std::string json() const;

  private:
    const DatasetDefinition& definition_;
    std::string csv_;
    std::string views_;  // of JSON, separated by commas
};

/// The entry of a view on a page.
struct PageView {
    std::string label;                  // "frame 12, left"
    std::vector<std::string> pictures;  // files relative to the set's folder
};

Manifest::Manifest(const DatasetDefinition& definition)
    : definition_(definition),
      csv_("view,draw,frame,time_s,stamp_ns,camera,tx,ty,tz,qx,qy,qz,qw,record,image") {
    for (const std::string& drawn : definition.draws.front())
        csv_ += "," + csv_text(drawn.substr(0, end_of_path(drawn)));
    csv_ += "\n";
}

void Manifest::add(const ViewRecord& record) {
    const View& view = record.view;
    const auto [p, q] = pose_of(record.camera.world_from_camera);
    const std::optional<int> frame = definition_.frames[view.frame];
    const std::string name = record_file(definition_, view);
    const SetFile* const image = record.file("image");
    csv_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", definition_.index(view),
                        view.draw, frame ? std::to_string(*frame) : "", record.time, record.stamp,
                        definition_.cameras[view.camera], p.x, p.y, p.z, q.x, q.y, q.z, q.w, name,
                        image ? image->path : "");
    for (const std::string& drawn : definition_.draws[view.draw])
        csv_ += "," + csv_text(std::string_view(drawn).substr(end_of_path(drawn) + 1));
    csv_ += "\n";
    Json files = Json::object();
    for (const SetFile& file : record.files) files[file.role] = file.path;
    const Json json{{"view", definition_.index(view)},
                    {"draw", view.draw},
                    {"frame", frame ? Json(*frame) : Json(nullptr)},
                    {"time_s", record.time},
                    {"stamp_ns", record.stamp},
                    {"camera", definition_.cameras[view.camera]},
                    {"position", point_json(p)},
                    {"rotation_wxyz", {q.w, q.x, q.y, q.z}},
                    {"record", name},
                    {"files", files}};
    views_ += (views_.empty() ? "" : ",\n") + json.dump();
}

std::string Manifest::json() const {
    return fmt::format("{{\"draws\": {},\n\"views\": [\n{}\n]}}\n", Json(definition_.draws).dump(),
                       views_);
}

std::string html_text(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

constexpr const char* k_page_head =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n<style>\n"
    "body {{ font: 15px/1.5 sans-serif; margin: 2em; background: #101418; color: #dde; }}\n"
    "a {{ color: #8cf; }}\n"
    "main {{ display: flex; flex-wrap: wrap; gap: 12px; }}\n"
    "figure {{ margin: 0; }}\n"
    "figure img {{ width: 320px; display: block; background: #000; }}\n"
    "figcaption {{ font-size: 13px; color: #9ab; }}\n"
    "</style>\n</head>\n<body>\n<h1>{0}</h1>\n";

/// A page with the pictures of a set, in HTML that needs nothing but the files beside it.
std::string dataset_page(const DatasetDefinition& definition, const std::vector<PageView>& views) {
    std::string page = fmt::format(k_page_head, html_text("Data set of " + definition.scene));
    page += fmt::format("<p>{}", counted(definition.view_count(), "view"));
    if (views.size() < definition.view_count())
        page += fmt::format(", {} of them here", views.size());
    page +=
        ". <a href=\"README.md\">data card</a>, <a href=\"manifest.csv\">manifest</a>, "
        "<a href=\"SHA256SUMS\">checksums</a></p>\n";
    page += fmt::format("<p><code>{}</code></p>\n<main>\n", html_text(definition.command));
    for (const PageView& view : views) {
        page += "<figure>";
        for (const std::string& picture : view.pictures)
            page +=
                fmt::format("<a href=\"{0}\"><img src=\"{0}\" loading=\"lazy\" alt=\"{1}\"></a>",
                            html_text(picture), html_text(view.label));
        page += fmt::format("<figcaption>{}</figcaption></figure>\n", html_text(view.label));
    }
    return page + "</main>\n</body>\n</html>\n";
}

namespace fs = std::filesystem;

constexpr std::size_t k_max_on_sheet = 60;
constexpr std::size_t k_max_on_page = 240;

class Completion {
  public:
    Completion(const fs::path& folder, const DatasetFile& set, const ProgressCallback& progress)
        : folder_(folder),
          set_(set),
          definition_(set.definition),
          sum_(sum_of(definition_)),
          progress_(progress),
          manifest_(definition_),
          files_(folder) {}

    void run(bool check) {
        check_inputs();
        if (check) check_files();
        remove_left_overs();
        for (std::size_t draw = 0; draw < definition_.draws.size(); ++draw) complete_draw(draw);
        write_pictures();
        files_.add_bytes("card", "README.md", data_card(set_, first_fits_, view_bytes_));
        files_.add_bytes("manifest", "manifest.csv", manifest_.csv());
        files_.add_bytes("manifest", "manifest.json", manifest_.json());
        files_.add("set", k_dataset_file, [](const fs::path&) {});  // is there
        write_checksums();
        tell(1);
    }

  private:
    void tell(double fraction) const {
        progress_(fraction);
        throw_if_stopped();
    }

    /// Checks that all existing views were rendered from the same files. This comes first, since
    /// otherwise the files that they share differ as well.
    void check_inputs() const {
        struct InputOf {
            std::string sum, view;  // of the first view that was rendered from it
        };
        std::map<std::string, InputOf> inputs;
        for (std::size_t index = 0; index < definition_.view_count(); ++index) {
            throw_if_stopped();
            const View view = definition_.view(index);
            const auto record = read_record(folder_, definition_, sum_, view);
            if (!record) continue;
            const std::string name = definition_.folder(view.draw) + definition_.stem(view);
            for (const auto& [file, sum] : record->inputs) {
                const auto [known, is_new] = inputs.try_emplace(file, InputOf{sum, name});
                if (is_new || known->second.sum == sum) continue;
                constexpr std::size_t k_shown = 12;  // digits
                throw InputError(fmt::format(
                    "{}: {} was rendered from another version of {} (SHA-256 {}...) than {} "
                    "({}...); run the same command again where the right one is, which renders "
                    "those views again that were made from others",
                    folder_.string(), name, printable(file, 200), sum.substr(0, k_shown),
                    known->second.view, known->second.sum.substr(0, k_shown)));
            }
        }
    }

    /// Checks all views' files by their content.
    void check_files() {
        std::mutex mutex;
        std::vector<std::size_t> faulty;
        std::atomic<std::size_t> done = 0;
        parallel_for(definition_.view_count(), [&](std::size_t index) {
            const View view = definition_.view(index);
            const bool is_there = complete_record(folder_, definition_, sum_, view).has_value();
            const std::lock_guard lock(mutex);
            if (!is_there) faulty.push_back(index);
            tell(k_checking * static_cast<double>(++done) /
                 static_cast<double>(definition_.view_count()));
        });
        refuse(std::move(faulty));
    }

    void refuse(std::vector<std::size_t> faulty) const {
        if (faulty.empty()) return;
        std::ranges::sort(faulty);
        constexpr std::size_t k_named = 5;
        std::string names;
        for (std::size_t i = 0; i < std::min(faulty.size(), k_named); ++i) {
            const View view = definition_.view(faulty[i]);
            names += (names.empty() ? "" : ", ") + definition_.folder(view.draw) +
                     definition_.stem(view);
        }
        throw InputError(fmt::format(
            "{}: {} of {} {} missing or damaged ({}{}); run their shards again, or the "
            "whole command, which keeps what is there",
            folder_.string(), faulty.size(), counted(definition_.view_count(), "view"),
            faulty.size() == 1 ? "is" : "are", names, faulty.size() > k_named ? ", ..." : ""));
    }

    /// Removes files that AtomicFile could not because its process was killed. No other machine
    /// works on the set any more, since all views exist.
    void remove_left_overs() const {
        std::error_code error;
        std::vector<fs::path> folders{folder_};
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_, error))
            if (entry.is_directory(error)) folders.push_back(entry.path());
        for (const fs::path& folder : folders) AtomicFile::remove_left_overs(folder, true);
    }

    void complete_draw(std::size_t draw) {
        CompleteSequence sequence{definition_, draw, definition_.folder(draw), {}, {}, {}};
        const std::size_t count = definition_.frames.size() * definition_.cameras.size();
        std::vector<std::size_t> missing;
        for (std::size_t i = draw * count; i < (draw + 1) * count; ++i) {
            const View view = definition_.view(i);
            auto record = read_record(folder_, definition_, sum_, view);
            if (!record || !record->has_all_files(folder_, false)) {
                missing.push_back(i);
                continue;
            }
            sequence.records.push_back(std::move(*record));
        }
        refuse(std::move(missing));
        for (const ViewRecord& record : sequence.records) take(record);
        take_shared(sequence);
        check_pinholes(sequence);
        if (draw == 0) first_fits_ = sequence.fits;
        for (const std::string& name : definition_.formats)
            if (const auto complete = dataset_format(name).complete) complete(sequence, files_);
        tell(k_checking + (1 - k_checking) * static_cast<double>(draw + 1) /
                              static_cast<double>(definition_.draws.size() + 1));
    }

    /// Lists the files that the views of a draw share, and reads those of which tables are made.
    void take_shared(CompleteSequence& sequence) {
        const std::vector<SetFile>& shared = sequence.records.front().shared;
        std::vector<std::size_t> others;
        for (const ViewRecord& record : sequence.records)
            if (record.shared != shared) others.push_back(definition_.index(record.view));
        refuse(std::move(others));
        for (const SetFile& file : shared) {
            files_.take(file);
            if (file.path == pinhole_file(definition_, sequence.draw))
                sequence.fits = read_pinholes(folder_ / file.path, definition_.cameras.size());
            if (file.path == imu_mounts_file(definition_, sequence.draw))
                sequence.imu_from_cameras =
                    read_imu_mounts(folder_ / file.path, definition_.cameras.size());
        }
    }

    /// With --pinhole-fit every camera that has a port is to have been fitted.
    void check_pinholes(const CompleteSequence& sequence) const {
        if (!definition_.pinhole_fit) return;
        for (std::size_t camera = 0; camera < definition_.cameras.size(); ++camera)
            if (sequence.at(0, camera).camera.port &&
                (camera >= sequence.fits.size() || !sequence.fits[camera]))
                throw InputError(fmt::format(
                    "{}{}: --pinhole-fit: there is no surface in view{}{} at whose distance a "
                    "pinhole could be fitted; make the set without it",
                    folder_.string(), sequence.folder.empty() ? "" : "/" + sequence.folder,
                    definition_.has_rig() ? " of " : "", definition_.cameras[camera]));
    }

    void take(const ViewRecord& record) {
        manifest_.add(record);
        for (const SetFile& file : record.files) {
            files_.take(file);
            view_bytes_ += file.bytes;
        }
        files_.add("record", record_file(definition_, record.view), [](const fs::path&) {});
        const std::size_t index = definition_.index(record.view);
        if (is_chosen(index, k_max_on_page)) show(record);
        const SetFile* const image = picture_of(record);
        if (image != nullptr && is_chosen(index, k_max_on_sheet))
            sheet_.push_back(folder_ / image->path);
    }

    /// Whether a view is among `most` that are spread evenly over all.
    bool is_chosen(std::size_t index, std::size_t most) const {
        const std::size_t count = definition_.view_count();
        if (count <= most) return true;
        return (index * most + most - 1) / count != ((index + 1) * most + most - 1) / count;
    }

    /// The picture of a view: its image, in the folder of the first format that has one.
    static const SetFile* picture_of(const ViewRecord& record) {
        const auto found = std::ranges::find_if(
            record.files, [](const SetFile& file) { return file.role.starts_with("image"); });
        return found == record.files.end() ? nullptr : &*found;
    }

    void show(const ViewRecord& record) {
        PageView view;
        view.label = definition_.folder(record.view.draw) + definition_.stem(record.view);
        if (const SetFile* image = picture_of(record)) view.pictures.push_back(image->path);
        if (const SetFile* clean = record.file("clean")) view.pictures.push_back(clean->path);
        page_.push_back(std::move(view));
    }

    void write_pictures() {
        if (!sheet_.empty())
            files_.add("sheet", "contact_sheet.png",
                       [&](const fs::path& file) { write_png(file, contact_sheet(sheet_), {}); });
        files_.add_bytes("page", "index.html", dataset_page(definition_, page_));
    }

    /// Writes the checksums by name, as sha256sum writes and checks them.
    void write_checksums() const {
        std::vector<SetFile> all = files_.written();
        std::ranges::sort(all, {}, &SetFile::path);
        std::string text;
        for (const SetFile& file : all) text += fmt::format("{}  {}\n", file.sha256, file.path);
        SetFiles(folder_).add_bytes("checksums", "SHA256SUMS", text);
    }

    static constexpr double k_checking = 0.5;  // of the work

    const fs::path& folder_;
    const DatasetFile& set_;
    const DatasetDefinition& definition_;
    std::string sum_;
    const ProgressCallback& progress_;
    Manifest manifest_;
    SetFiles files_;
    std::uint64_t view_bytes_ = 0;
    PinholeFits first_fits_;  // of the first draw
    std::vector<PageView> page_;
    std::vector<fs::path> sheet_;
};

}  // namespace

void complete_dataset(const fs::path& folder, const DatasetFile& set, bool check,
                      const ProgressCallback& progress) {
    Completion(folder, set, progress).run(check);
}

}  // namespace uw
