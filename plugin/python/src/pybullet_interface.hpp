// What PyBullet and its plug-ins hand each other, as of its API version 202010061. PyBullet's headers are not
// packaged, so the layouts are declared here; attach() checks that they are understood.
#pragma once

namespace innersphere::pybullet {

/// The version that initPlugin has to return. PyBullet unloads plug-ins that return another one.
constexpr int kApiVersion = 202010061;

/// Arguments of p.executePluginCommand().
struct Arguments {
  char text[1024];
  int int_count;
  int ints[128];
  int float_count;
  double floats[128];
};

/// What a plug-in is called with. There is one for each time that it is loaded.
struct Context {
  void* client;
  void* user;  ///< the plug-in's own
  void* return_data;
  const void* vr_events;
  int vr_event_count;
  const void* key_events;
  int key_event_count;
  const void* mouse_events;
  int mouse_event_count;
  const void* notifications;
  int notification_count;
  void* command_processor;  ///< executes commands, and holds the world
};

}  // namespace innersphere::pybullet
