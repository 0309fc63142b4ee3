#include "running/run_viewers.hpp"

#include <memory>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "lab_commands/lab_commands.hpp"
#include "messages.hpp"
#include "viewing/preview.hpp"
#include "window/window.hpp"

namespace hypotrack::app {
namespace {

void open_web(const ViewerOptions& options, LiveRun& live) {
  const bool has_rules =
      options.token.word || options.token.file || options.web.host != LiveViewOptions().host;
  if (!options.web_port && has_rules)
    throw ConfigError(
        "--web-host, --web-token and --web-token-file belong to a live view; give --web PORT, too");
  if (!options.web_port) return;
  WebToken token =
      read_web_token(options.token, [](const std::string& text) { tell("{}\n", text); });
  LiveViewOptions web = options.web;
  web.port = *options.web_port;
  web.token = std::move(token.word);
  web.token_source = std::move(token.source);
  std::unique_ptr<LiveView> page = lab().commands->open_live_view(web, live.controls());
  tell("live view: {}\n", page->address());
  live.add(std::move(page));
}

}  // namespace

void add_viewer_options(const Command& command, ViewerOptions& options) {
  command.add("--preview", &options.preview,
              "Show and steer the run in a window; h lists the keys");
  command.add("--web", &options.web_port,
              "Show the run as a web page on this port; 0: any free one",
              {.check = whole_number(0, 65535), .if_bare = "8080"});
  command.add("--web-host", &options.web.host, "Address at which others reach the page",
              {.show_default = true, .check = file_name()});
  command.add("--web-token-file", &options.token.file,
              "File with a secret word that the page's address needs; the variable "
              "HYPOTRACK_WEB_TOKEN may have the word, too",
              {.check = file_name()});
  command.add(
      "--web-token", &options.token.word,
      "The secret word itself; others may read it until the program has begun",
      {.check = {.problem =
                     [](const std::string& text) {
                       return std::string(text.empty() ? "is empty, expected a secret word" : "");
                     }},
       .value_name = "WORD",
       .secret = true});
  options.token.variable = take_web_token_variable();
}

void open_viewers(const ViewerOptions& options, LiveRun& live) {
  if (options.preview) {
    check_display("watch it in a browser: --web in place of --preview");
    live.add(make_preview(live.controls(), show_in_process,
                          [](const std::string& text) { tell("{}\n", text); }));
  }
  open_web(options, live);
}

}  // namespace hypotrack::app
