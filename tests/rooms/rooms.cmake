# The rooms of each library, from the bottom up. A room may include itself and the rooms before it. Rooms joined by | are
# siblings: neither includes the other.
set(libraries packing gpu plugin)
set(packing_rooms common packing file mesh mesh/import solids packer)
set(gpu_rooms core common surface grid batch cpu|cuda patches query)
set(plugin_rooms common surface shape narrow_phase/shapes narrow_phase solver response pair_cache bullet)
