"""The laboratory: experiments on many curves, and what only they need; commands join by entry points."""
