# A table for the planted faults beside it.
set(libraries gpu)
set(gpu_rooms core cpu|cuda)
