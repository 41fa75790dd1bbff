// Certificates of a test's own: an authority, and what it signs, as PEM files.
//
// Units/frames: none.
// Ownership:    files lie in the folder that is given.
// Threads:      none.
// Failure:      aborts where OpenSSL refuses.
#pragma once

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace dance {

class Authority {
 public:
  Authority(const std::string& folder, const std::string& name)
      : folder_(folder),
        key_(EVP_EC_gen("P-256"), EVP_PKEY_free),
        certificate_(nullptr, X509_free) {
    certificate_ = signed_for(name, "", key_.get(), true);
    write(name + ".pem", certificate_.get());
    file = folder_ + "/" + name + ".pem";
  }

  // Writes NAME.pem and NAME.key; `where` is what a server is reached by, as "IP:127.0.0.1".
  void sign(const std::string& name, const std::string& where) {
    const Key key(EVP_EC_gen("P-256"), EVP_PKEY_free);
    const Certificate certificate = signed_for(name, where, key.get(), false);
    write(name + ".pem", certificate.get());
    std::FILE* out = std::fopen((folder_ + "/" + name + ".key").c_str(), "w");
    if (!out || PEM_write_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1)
      std::abort();
    std::fclose(out);
  }

  // Writes a file of this authority and its revocation list, which has the certificate of NAME.pem
  // if a name is given. The list is out of date after this many seconds.
  std::string write_revocations(const std::string& name, long valid_s) {
    std::unique_ptr<X509_CRL, void (*)(X509_CRL*)> list(X509_CRL_new(), X509_CRL_free);
    X509_CRL_set_version(list.get(), 1);
    X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(certificate_.get()));
    const std::unique_ptr<ASN1_TIME, void (*)(ASN1_TIME*)> begin(X509_gmtime_adj(nullptr, -3600),
                                                                 ASN1_TIME_free),
        end(X509_gmtime_adj(nullptr, valid_s), ASN1_TIME_free);
    X509_CRL_set1_lastUpdate(list.get(), begin.get());
    X509_CRL_set1_nextUpdate(list.get(), end.get());
    if (!name.empty()) {
      std::FILE* in = std::fopen((folder_ + "/" + name + ".pem").c_str(), "r");
      const Certificate revoked(in ? PEM_read_X509(in, nullptr, nullptr, nullptr) : nullptr,
                                X509_free);
      if (!revoked) std::abort();
      std::fclose(in);
      X509_REVOKED* entry = X509_REVOKED_new();
      X509_REVOKED_set_serialNumber(entry, X509_get_serialNumber(revoked.get()));
      X509_REVOKED_set_revocationDate(entry, begin.get());
      if (X509_CRL_add0_revoked(list.get(), entry) != 1) std::abort();
    }
    const std::string path = folder_ + "/revocations.pem";
    std::FILE* out = std::fopen(path.c_str(), "w");
    if (X509_CRL_sign(list.get(), key_.get(), EVP_sha256()) == 0 || !out ||
        PEM_write_X509(out, certificate_.get()) != 1 || PEM_write_X509_CRL(out, list.get()) != 1)
      std::abort();
    std::fclose(out);
    return path;
  }

  std::string file;

 private:
  using Key = std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)>;
  using Certificate = std::unique_ptr<X509, void (*)(X509*)>;

  Certificate signed_for(const std::string& name, const std::string& where, EVP_PKEY* key,
                         bool is_authority) {
    static long serial = 1;
    Certificate made(X509_new(), X509_free);
    X509_set_version(made.get(), 2);
    ASN1_INTEGER_set(X509_get_serialNumber(made.get()), serial++);
    X509_gmtime_adj(X509_getm_notBefore(made.get()), -3600);
    X509_gmtime_adj(X509_getm_notAfter(made.get()), 3600 * 24);
    X509_NAME_add_entry_by_txt(X509_get_subject_name(made.get()), "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
    X509_set_issuer_name(made.get(), is_authority ? X509_get_subject_name(made.get())
                                                  : X509_get_subject_name(certificate_.get()));
    X509_set_pubkey(made.get(), key);
    add(made.get(), NID_basic_constraints, is_authority ? "critical,CA:TRUE" : "CA:FALSE");
    if (!where.empty()) add(made.get(), NID_subject_alt_name, where);
    if (X509_sign(made.get(), key_.get(), EVP_sha256()) == 0) std::abort();
    return made;
  }

  static void add(X509* to, int what, const std::string& value) {
    X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, nullptr, what, value.c_str());
    if (!extension || X509_add_ext(to, extension, -1) != 1) std::abort();
    X509_EXTENSION_free(extension);
  }

  void write(const std::string& name, X509* certificate) {
    std::FILE* out = std::fopen((folder_ + "/" + name).c_str(), "w");
    if (!out || PEM_write_X509(out, certificate) != 1) std::abort();
    std::fclose(out);
  }

  std::string folder_;
  Key key_;
  Certificate certificate_;
};

}  // namespace dance
