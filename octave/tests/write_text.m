% Writes a text to a file.
function write_text(path, text)
file = fopen(path, 'w');
fwrite(file, text);
fclose(file);
end
