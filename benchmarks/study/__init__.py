"""From a folder to a study: growth, atlases and models against what is known exactly."""
