"""The paper's transcription: every free curve is a smoothing spline of its data, eqs (11)-(17)."""
