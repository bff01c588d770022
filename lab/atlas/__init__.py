"""The minima that batches have found, as pages to read and as a data package."""
