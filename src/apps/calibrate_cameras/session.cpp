#include "calibrate_cameras/session.h"

#include <cstdio>

#include "calibrate_cameras/console.h"
#include "calibrate_cameras/outputs.h"
#include "calibrate_cameras/report.h"
#include "common/interrupt.h"
#include "common/program.h"
#include "common/recording.h"

namespace tartan_calib::apps {
namespace {

void reportOn(const pipeline::CalibrationResult& result, const Inputs& inputs, const Arguments& arguments,
              Console& console) {
  const UninterruptedSection leaves_nothing_behind;
  std::printf("Generating result report...\n");
  std::fflush(stdout);
  setInterruptedStep("before the report was drawn");
  const auto show = [&console](const auto& step, auto done, auto total) { console.showStep(step, done, total); };
  const ReportFiles files = writeReport(result, inputs, outputPrefix(arguments), {show, isInterruptWaiting});
  if (files.html.empty() && isInterruptWaiting()) {
    return;
  }
  setInterruptedStep("");
  setFinishedWork("results and report are written");
  console.printReport(files);
  if (arguments.show_report) {
    showReport(files);
  }
}

/// A word as a shell reads it back.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
    return word;
  }
  std::string text = "'";
  for (const char letter : word) {
    text += letter == '\'' ? "'\\''" : std::string(1, letter);
  }
  return text + "'";
}

}  // namespace

std::string commandText(const std::string& program, const std::vector<std::string>& words) {
  std::string text = program;
  for (const std::string& word : words) {
    text += " " + quoted(word);
  }
  return text;
}

void runSession(const Arguments& arguments, const std::string& command, const SessionHooks& hooks) {
  for (const std::string& note : arguments.notes) {
    printWarning(note);
  }
  if (arguments.corners_file.empty()) {
    checkIsThere(arguments.recording);
  }
  checkInputsStay(arguments);
  checkWritable(outputPrefix(arguments));
  const Inputs inputs = openInputs(arguments, printWarning);
  Console console(inputs);
  pipeline::Listener listener = console.listener();
  if (hooks.detection_solved) {
    listener.detection_solved = [&](const pipeline::CalibrationResult& result) { hooks.detection_solved(inputs, result); };
  }
  const pipeline::CalibrationResult result = calibrate(inputs, listener);
  console.printResult(result);
  if (arguments.verbose) {
    console.printTimes(result);
  }
  OutputFiles files;
  {
    const UninterruptedSection files_are_written_whole;
    files = writeOutputs(result, arguments, inputs.options, command);
    console.printFiles(files);
    setFinishedWork("the results above are written and complete");
  }
  if (hooks.finished) {
    hooks.finished(inputs, result);
  }
  const UninterruptedSection all_files_are_named;
  if (arguments.report) {
    reportOn(result, inputs, arguments, console);
  }
  console.printExports(files);
}

}  // namespace tartan_calib::apps
