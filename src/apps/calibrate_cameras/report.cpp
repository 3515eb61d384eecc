#include "calibrate_cameras/report.h"

#include <spawn.h>
#include <stdlib.h>  // mkdtemp
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "tartan_calib/report/analysis.h"
#include "tartan_calib/report/draw.h"
#include "tartan_calib/report/pictures.h"
#include "tartan_calib/report/report_data.h"

namespace tartan_calib::apps {
namespace {

namespace fs = std::filesystem;

/// A new folder that goes away with its content.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "tartan_calib-report-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw InputError("cannot make a folder such as " + name + " (" + std::strerror(errno) + ")");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

/// Programs are in <prefix>/lib/<package>, the script in <prefix>/share/<package>/report, both in devel and install space.
std::string scriptPath() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path package = program.parent_path().filename();
  return (program.parent_path().parent_path().parent_path() / "share" / package / "report" / "draw_report.py").string();
}

report::Listener stepListener(const std::string& step, const ReportListener& listener) {
  report::Listener of_step;
  of_step.is_cancelled = listener.is_cancelled;
  if (listener.progress) {
    of_step.progress = [step, tell = listener.progress](std::size_t done, std::size_t total) { tell(step, done, total); };
  }
  return of_step;
}

}  // namespace

ReportFiles writeReport(const pipeline::CalibrationResult& result, const Inputs& inputs, const std::string& prefix,
                        const ReportListener& listener) {
  ReportFiles files;
  try {
    const TemporaryFolder folder;
    report::PictureOptions options;
    options.num_threads = inputs.options.num_threads;
    options.listener = stepListener("Pictures of the views", listener);
    const auto corners = report::seenCorners(result);
    const auto pictures = report::takePictures(inputs.streams, result, corners, folder.path(), options);
    const report::Analysis analysis =
        report::analyse(result, inputs.options, corners, pictures, stepListener("Analysis", listener));
    files.verdict = report::judge(result, analysis);
    report::writeReportData(folder.path(), {inputs.dataset, result, analysis, *files.verdict, pictures});
    const std::string pdf = prefix + "-report-cam.pdf";
    const std::string html = prefix + "-report-cam.html";
    report::drawReport(scriptPath(), folder.path(), pdf, html, stepListener("Drawing the report", listener));
    files.pdf = pdf;
    files.html = html;
  } catch (const std::exception& error) {  // the calibration is written; a report is not worth failing for
    files.failure = error.what();
  }
  return files;
}

void showReport(const ReportFiles& files) {
  if (files.html.empty() || isatty(STDOUT_FILENO) == 0 || std::getenv("DISPLAY") == nullptr) {
    return;
  }
  std::string program = "xdg-open";
  std::string page = files.html;
  char* words[] = {program.data(), page.data(), nullptr};  // the interface of exec
  pid_t process = 0;
  posix_spawnp(&process, words[0], nullptr, nullptr, words, environ);  // where it is absent, nothing is shown
}

}  // namespace tartan_calib::apps
