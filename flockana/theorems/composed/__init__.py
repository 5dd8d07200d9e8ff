"""What holds of every composition of terms, one file each."""
