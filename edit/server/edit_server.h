#pragma once

#include <memory>
#include <string>

#include "edit/session/edit_session.h"

namespace uw {

/// The address of the editor. `everywhere` is for containers, whose ports are published on the
/// addresses of their host: requests come by the network then, but have to name 127.0.0.1 or
/// localhost as ever.
enum class EditAddress { this_machine, everywhere };

// The interface of the editor: what its page and the Blender add-on ask of the server. It may
// change with any version.
//
// All paths are below the address's token. Requests and answers are JSON in UTF-8. The state lives
// in the server: every window sees the same. A connection is closed after one answer, and one whose
// request stops arriving for 2 s is closed, too.
//
//   GET /, /page/FILE          the page
//   GET /api/state             everything but pixels: state_json.h
//   GET /api/outlines          {"key", "segments": [[x,y,z, x,y,z], ...]}: edges of surfaces [m],
//                              to be fetched when state.outlines.key changes
//   POST /api/edit             {"revision", "label", "group", "changes"}: edited_scene.h;
//                              the answer is the new state
//   POST /api/show             {"camera": "right", "frame": 12}, either alone: what is shown of a
//                              rig, or of what moves; not part of the scene
//   POST /api/undo, /api/redo  {}
//   POST /api/reload           {}: takes the scene from its file
//   POST /api/save             {"overwrite": false}; 409 if the file has changed on disk since
//                              it was read, 422 if it cannot be written
//   POST /api/save_as          {"file": "x.yaml", "overwrite": false}: in the scene's folder;
//                              409 if it exists, and if it is a symbolic link in any case
//   GET /api/events            server-sent events
//   GET /api/image             ?min=KEY&type=f16: the newest picture (picture.h); 204 if there is
//                              none, or none whose key is at least `min`
//   GET /api/view              the table of the scene's `view` (view_table.h); 409 if there is none
//   GET /api/numbers           ?x0=&y0=&x1=&y1=&ratio=1&curves=1: session_measures.h
//   POST /api/suggest          starts a search for a lamp's position: session_measures.h
//   POST /api/suggest/cancel   {}
//   GET /api/export/numbers.csv  the numbers, always with curves
//   GET /api/export/picture.png  ?exposure=2: the image as uwvdb render makes it, without lamps
//                              that are off; by default with its automatic exposure
//
// An error is {"error": "one line"} and changes nothing: 400 malformed request; 403 wrong token,
// Host or Origin; 404; 405; 409 outrun by another window or another program; 411; 413 more than 256
// KiB; 414; 415 not application/json; 422 the value is wrong, or a file cannot be read or written;
// 500; 503 more than 16 windows.
//
// Events; a comment comes every 15 s:
//
//   hello     {}: fetch state and picture; also after each reconnection
//   state     {"revision"}: fetch the state
//   image     {"key", "revision", "width", "height", "quality"}: fetch the picture
//   progress  {"stage", "fraction"}
//   suggest   a search's state: session_measures.h
//   error     {"message"}: the picture cannot be rendered

/// Serves the page of the lamp editor, and the session behind it, on 127.0.0.1. Whoever does not
/// know the address's token, and any page of another origin, is refused. Connections that say
/// nothing cost nothing.
class EditServer {
  public:
    /// Listens to `port`, 0 for any that is free, from now on; `session` outlives it. Throws
    /// IoError if the port is taken.
    EditServer(EditSession& session, int port, EditAddress where = EditAddress::this_machine);
    ~EditServer();
    EditServer(const EditServer&) = delete;
    EditServer& operator=(const EditServer&) = delete;
    EditServer(EditServer&&) = delete;
    EditServer& operator=(EditServer&&) = delete;

    int port() const;
    /// 128 random bits as 32 hex digits.
    const std::string& token() const;
    /// "http://127.0.0.1:41873/0123.../"
    std::string address() const;

  private:
    class Page;
    std::unique_ptr<Page> page_;
};

}  // namespace uw
