"""The one verb, on meshes so coarse and with iterations so few that it is quick."""
