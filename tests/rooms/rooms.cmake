# The rooms of each library, from the bottom up. A room may include itself and the rooms before it. Rooms joined by | are
# siblings: neither includes the other. packing's rooms common and surface are also below those of gpu and
# plugin.
set(libraries packing gpu plugin)
set(packing_rooms common surface packing file mesh mesh/import solids packer)
set(gpu_rooms common core surface grid batch cpu|cuda patches query)
set(plugin_rooms common surface shape narrow_phase/shapes narrow_phase solver response pair_cache bullet)
